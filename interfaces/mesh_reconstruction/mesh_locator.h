#pragma once

#include <array>

#include "interfaces/mesh_reconstruction/mesh_subdivision.h"
#include "interfaces/network/box_tree.h"

namespace adamas::interfaces {

/// Finds the tetrahedra of a subdivision that hold places.
class MeshLocator {
 public:
  using Index = MeshSubdivision::Index;
  /// The tetrahedron that holds a place, and the weights of its corners.
  struct Location {
    std::array<Index, 4> corners;
    std::array<double, 4> weights;
    Index cell;
  };

  /// The subdivision must outlive this object.
  explicit MeshLocator(const MeshSubdivision& subdivision);

  /// Returns the location of a place; beyond the mesh, that in a tetrahedron near it.
  [[nodiscard]] Location locate(const Vec3& p) const;

 private:
  const MeshSubdivision& subdivision_;
  BoxTree boxes_;  ///< of cells
};

}  // namespace adamas::interfaces
