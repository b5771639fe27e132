#pragma once

#include <string>

#include "cli/console.h"
#include "interfaces/selection/saved_hierarchy.h"

namespace adamas {

/// Whether a file is a hierarchy that adamas resample has saved; false where there is none.
bool is_saved_hierarchy(const std::string& path);

/// Throws Error for another file, and for one that is damaged.
SavedHierarchy load_saved_hierarchy(const std::string& path, Console& console);

}  // namespace adamas
