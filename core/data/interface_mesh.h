#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/meshes.h"
#include "core/base/typed_id.h"

namespace adamas::inline core {

/// A triangle with a material on either side; by the right-hand rule its normal points to `front`.
struct InterfaceTriangle {
  std::array<std::uint32_t, 3> points;
  MaterialId front, back;
  bool operator==(const InterfaceTriangle&) const = default;
};

/// A network of material interfaces: triangles on shared points, three or more of which may meet at an edge.
struct InterfaceMesh {
  std::string source;  ///< the file or generator, for messages
  std::vector<Vec3> points;
  std::vector<InterfaceTriangle> triangles;
  IdVector<MaterialId, std::string> materials;

  [[nodiscard]] Vec3 centroid(std::size_t triangle) const {
    const auto& p = triangles[triangle].points;
    return (1.0 / 3) * (points[p[0]] + points[p[1]] + points[p[2]]);
  }
};

/// Converts a network for users of the library; points and names are moved. `bodies`: those in front of each
/// triangle and behind it; empty where they are not known.
InterfaceTriangles to_interface_triangles(InterfaceMesh&& mesh,
                                          const std::vector<std::array<BodyId, 2>>& bodies = {});
/// Converts a network of a user of the library. Throws Error, which begins with `name`, where arrays do not
/// fit each other.
InterfaceMesh to_interface_mesh(const InterfaceTriangles& mesh, const std::string& name);

}  // namespace adamas::inline core
