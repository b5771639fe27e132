#include "adamas/comparison.h"

namespace adamas {

std::string mesh_name(MeshKind kind) {
  switch (kind) {
    case MeshKind::kOwn:
      return "adamas";
    case MeshKind::kOwnCut:
      return "adamas cut";
    case MeshKind::kTetGen:
      return "TetGen (our interfaces)";
    case MeshKind::kTetGenUntouched:
      return "TetGen (input's)";
    case MeshKind::kTetGenSimplified:
      return "TetGen (simplified)";
    case MeshKind::kMesh3Simplified:
      return "Mesh_3 (simplified)";
    case MeshKind::kMesh3Labels:
      return "Mesh_3 (labels)";
    case MeshKind::kMesh3:
      return "Mesh_3";
    case MeshKind::kMesh3Optimised:
      return "Mesh_3 optimised";
  }
  return "";
}

}  // namespace adamas
