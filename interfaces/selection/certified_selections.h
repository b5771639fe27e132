#pragma once

#include "adamas/progress.h"
#include "interfaces/selection/saved_hierarchy.h"

namespace adamas::interfaces {

/// Sets the certified errors of a hierarchy whose cells have estimates. Meshes are chosen from it from the
/// coarsest on, each for an error a little less than the last; they are split where they are too far from the
/// input's interfaces, and measured (docs/method.md, Selections). Throws Cancelled if the progress requests
/// it.
void certify_selections(SavedHierarchy& hierarchy, const ResamplingSource& source, Progress& progress);

}  // namespace adamas::interfaces
