#pragma once

#include <string>

#include "adamas/select.h"
#include "interfaces/selection/saved_hierarchy.h"

namespace adamas {

/// What stands behind a MultiresolutionMesh.
struct MultiresolutionMesh::Contents {
  std::string name;
  interfaces::SavedHierarchy hierarchy;
};

}  // namespace adamas
