#pragma once

#include <string>

#include "adamas/select.h"
#include "interfaces/selection/saved_hierarchy.h"

namespace adamas {

/// The implementation of a MultiresolutionMesh.
struct MultiresolutionMesh::Contents {
  std::string name;
  interfaces::SavedHierarchy hierarchy;
};

}  // namespace adamas
