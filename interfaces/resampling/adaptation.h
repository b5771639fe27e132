#pragma once

#include "adamas/resample.h"
#include "interfaces/resampling/refinement.h"
#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

using adamas::Adaptation;

/// Adapts the hierarchy of a state, which was made for other data and whose roots alone are evaluated: cells
/// are merged and split until it is the one that refinement of the interfaces from the roots gives, with the
/// same numbers. There must be no greatest number of tetrahedra.
Adaptation adapt_hierarchy(ResamplingState& state, Refinement& refinement);

}  // namespace adamas::interfaces
