#include "interfaces/reference/conforming_mesh.h"

#include <algorithm>

#include "core/base/error.h"

namespace adamas {

namespace {

/// A face by its corners in ascending order, and where it comes from.
struct Face {
  std::array<std::uint32_t, 3> corners;
  std::uint32_t tetrahedron;
  std::uint8_t opposite;

  bool operator<(const Face& other) const {
    return corners != other.corners ? corners < other.corners : tetrahedron < other.tetrahedron;
  }
};

}  // namespace

std::vector<std::array<std::uint32_t, 4>> find_neighbours(
    const std::vector<std::array<std::uint32_t, 4>>& tetrahedra, const std::string& name) {
  std::vector<Face> faces;
  faces.reserve(4 * tetrahedra.size());
  for (std::uint32_t t = 0; t < tetrahedra.size(); ++t) {
    const auto& v = tetrahedra[t];
    for (std::uint8_t i = 0; i < 4; ++i) {
      Face face{{v[(i + 1) % 4], v[(i + 2) % 4], v[(i + 3) % 4]}, t, i};
      std::sort(face.corners.begin(), face.corners.end());
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end());
  std::vector<std::array<std::uint32_t, 4>> result(tetrahedra.size(),
                                                   {kNoNeighbour, kNoNeighbour, kNoNeighbour, kNoNeighbour});
  for (std::size_t begin = 0, end = 0; begin < faces.size(); begin = end) {
    while (end < faces.size() && faces[end].corners == faces[begin].corners) ++end;
    if (end - begin > 2) fail("{}: expected at most two tetrahedra at a face, found {}", name, end - begin);
    if (end - begin < 2) continue;
    const Face &a = faces[begin], &b = faces[begin + 1];
    result[a.tetrahedron][a.opposite] = b.tetrahedron;
    result[b.tetrahedron][b.opposite] = a.tetrahedron;
  }
  return result;
}

std::vector<ClosestPointTree::Triangle> interface_faces(const ConformingMesh& mesh) {
  const auto neighbours = find_neighbours(mesh.tetrahedra, "mesh");
  std::vector<ClosestPointTree::Triangle> result;
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t other = neighbours[t][i];
      if (other == kNoNeighbour || other < t || mesh.bodies[other] == mesh.bodies[t]) continue;
      const auto& v = mesh.tetrahedra[t];
      result.push_back({v[(i + 1) % 4], v[(i + 2) % 4], v[(i + 3) % 4]});
    }
  }
  return result;
}

IdVector<BodyId, double> body_volumes(const ConformingMesh& mesh, std::size_t bodies) {
  IdVector<BodyId, double> volumes(bodies, 0.0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto x = mesh.corners(t);
    volumes[mesh.bodies[t]] += signed_volume(x[0], x[1], x[2], x[3]);
  }
  return volumes;
}

}  // namespace adamas
