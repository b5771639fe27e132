#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/typed_id.h"
#include "core/distance/closest_point_tree.h"
#include "interfaces/mesh/interface_extraction.h"

namespace adamas::interfaces {

/// A tetrahedral mesh whose interfaces are faces: each tetrahedron lies in one body.
struct ConformingMesh {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;  ///< positively oriented or flat
  std::vector<BodyId> bodies;                            ///< the body of each tetrahedron

  [[nodiscard]] std::array<Vec3, 4> corners(std::size_t t) const {
    const auto& v = tetrahedra[t];
    return {points[v[0]], points[v[1]], points[v[2]], points[v[3]]};
  }
};

/// The smallest and the greatest angle between two faces of a tetrahedron, in degrees.
struct DihedralRange {
  double min = 180, max = 0;
  void add(const std::array<Vec3, 4>& corners);
};

/// Returns the range of the angles of all tetrahedra of a mesh.
DihedralRange dihedral_range(const ConformingMesh& mesh);

/// Returns the faces between two bodies, each once.
std::vector<ClosestPointTree::Triangle> interface_faces(const ConformingMesh& mesh);

/// Returns the faces between two bodies with the bodies in front and behind, and only their points. Names are
/// set by the caller.
ExtractedInterfaces interfaces_of(const ConformingMesh& mesh, const InterfaceTable& table);

/// Returns the volume of each body, in the cube of the unit of length. `bodies`: the number of bodies.
IdVector<BodyId, double> body_volumes(const ConformingMesh& mesh, std::size_t bodies);

/// Returns for each tetrahedron its neighbours beyond the faces opposite to its corners; kNoNeighbour if
/// there is none. Throws Error that begins with `name` if more than two tetrahedra share a face.
inline constexpr std::uint32_t kNoNeighbour = 0xffffffffu;
std::vector<std::array<std::uint32_t, 4>> find_neighbours(
    const std::vector<std::array<std::uint32_t, 4>>& tetrahedra, const std::string& name);

}  // namespace adamas::interfaces
