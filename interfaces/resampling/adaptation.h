#pragma once

#include <cstddef>

#include "interfaces/resampling/refinement.h"
#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

/// What became of the diamonds of a hierarchy that was adapted to other data.
struct Adaptation {
  std::size_t kept = 0;    ///< split before and afterwards
  std::size_t merged = 0;  ///< split before alone
  std::size_t split = 0;   ///< split afterwards alone
};

/// Adapts the hierarchy of a state, which was made for other data and whose roots alone are evaluated: cells
/// are merged and split until it is the one that refinement of the interfaces from the roots gives, with the
/// same numbers. There must be no greatest number of tetrahedra.
Adaptation adapt_hierarchy(ResamplingState& state, Refinement& refinement);

}  // namespace adamas::interfaces
