#pragma once

#include "adamas/resample.h"
#include "interfaces/resampling/refinement.h"
#include "interfaces/resampling/resampling_state.h"

namespace adamas::interfaces {

using adamas::Adaptation;

/// Adapts the hierarchy of a state that was made for other data and of which only the roots are evaluated.
/// Cells are merged and split until the hierarchy, including all numbers, is the one that refinement of the
/// interfaces from the roots gives. The options must not limit the number of tetrahedra.
Adaptation adapt_hierarchy(ResamplingState& state, Refinement& refinement);

}  // namespace adamas::interfaces
