#pragma once

#include "adamas/progress.h"
#include "core/base/error.h"
#include "interfaces/selection/saved_hierarchy.h"

namespace adamas::interfaces {

/// Sets the certified errors of a hierarchy whose cells have estimates: meshes are chosen from it from the
/// coarsest on, for errors each a little less than the last, split where measuring finds them too far from
/// the input's interfaces, and measured (docs/method.md, Selections). Throws Cancelled where the progress
/// says so.
void certify_selections(SavedHierarchy& hierarchy, const ResamplingSource& source, Progress& progress);

}  // namespace adamas::interfaces
