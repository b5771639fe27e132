#include "interfaces/mesh/conforming_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"

namespace adamas::interfaces {

namespace {

/// A face with its corners in ascending order, its tetrahedron and the opposite corner.
struct Face {
  std::array<std::uint32_t, 3> corners;
  std::uint32_t tetrahedron;
  std::uint8_t opposite;

  bool operator<(const Face& other) const {
    return corners != other.corners ? corners < other.corners : tetrahedron < other.tetrahedron;
  }
};

/// Calls visit(face, opposite corner, tetrahedron, tetrahedron beyond) for each face between two bodies.
template <class Visit>
void for_each_interface_face(const ConformingMesh& mesh, Visit&& visit) {
  const auto neighbours = find_neighbours(mesh.tetrahedra, "mesh");
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t other = neighbours[t][i];
      if (other == kNoNeighbour || other < t || mesh.bodies[other] == mesh.bodies[t]) continue;
      const auto& v = mesh.tetrahedra[t];
      visit(ClosestPointTree::Triangle{v[(i + 1) % 4], v[(i + 2) % 4], v[(i + 3) % 4]}, v[i], t, other);
    }
  }
}

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

void DihedralRange::add(const std::array<Vec3, 4>& x) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      // The edge from i to j has two faces, each with one of the other two corners.
      std::array<std::size_t, 2> other{};
      for (std::size_t k = 0, n = 0; k < 4; ++k) {
        if (k != i && k != j) other[n++] = k;
      }
      const Vec3 a = cross(x[j] - x[i], x[other[0]] - x[i]), b = cross(x[j] - x[i], x[other[1]] - x[i]);
      const double angle = std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
      min = std::min(min, angle);
      max = std::max(max, angle);
    }
  }
}

DihedralRange dihedral_range(const ConformingMesh& mesh) {
  DihedralRange range;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) range.add(mesh.corners(t));
  return range;
}

std::vector<ClosestPointTree::Triangle> interface_faces(const ConformingMesh& mesh) {
  std::vector<ClosestPointTree::Triangle> result;
  for_each_interface_face(mesh, [&](const ClosestPointTree::Triangle& face, std::uint32_t, std::uint32_t,
                                    std::uint32_t) { result.push_back(face); });
  return result;
}

ExtractedInterfaces interfaces_of(const ConformingMesh& mesh, const InterfaceTable& table) {
  ExtractedInterfaces result;
  std::vector<std::uint32_t> number(mesh.points.size(), kNoNeighbour);
  for_each_interface_face(mesh, [&](ClosestPointTree::Triangle face, std::uint32_t opposite, std::uint32_t t,
                                    std::uint32_t other) {
    // The normal points into the tetrahedron.
    if (signed_volume(mesh.points[face[0]], mesh.points[face[1]], mesh.points[face[2]],
                      mesh.points[opposite]) < 0)
      std::swap(face[1], face[2]);
    for (std::uint32_t& p : face) {
      if (number[p] == kNoNeighbour) {
        number[p] = static_cast<std::uint32_t>(result.mesh.points.size());
        result.mesh.points.push_back(mesh.points[p]);
      }
      p = number[p];
    }
    const BodyId front = mesh.bodies[t], back = mesh.bodies[other];
    result.mesh.triangles.push_back({face, table.material(front), table.material(back)});
    result.bodies.push_back({front, back});
  });
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

}  // namespace adamas::interfaces
