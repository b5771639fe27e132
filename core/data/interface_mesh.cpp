#include "core/data/interface_mesh.h"

#include "core/base/error.h"

namespace adamas::inline core {

InterfaceTriangles to_interface_triangles(InterfaceMesh&& mesh,
                                          const std::vector<std::array<BodyId, 2>>& bodies) {
  InterfaceTriangles result{std::move(mesh.points), {}, {}, std::move(mesh.materials), {}};
  result.triangles.reserve(mesh.triangles.size());
  result.sides.reserve(mesh.triangles.size());
  for (const InterfaceTriangle& t : mesh.triangles) {
    result.triangles.push_back(t.points);
    result.sides.push_back({t.front.value, t.back.value});
  }
  result.bodies.reserve(bodies.size());
  for (const auto& [front, back] : bodies) result.bodies.push_back({front.value, back.value});
  return result;
}

InterfaceMesh to_interface_mesh(const InterfaceTriangles& mesh, const std::string& name) {
  if (mesh.sides.size() != mesh.triangles.size())
    fail("{}: expected sides of {} triangles, found {}", name, mesh.triangles.size(), mesh.sides.size());
  InterfaceMesh result;
  result.source = name;
  result.points = mesh.points;
  result.materials.assign(mesh.materials.begin(), mesh.materials.end());
  result.triangles.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t p : mesh.triangles[t]) {
      if (p >= mesh.points.size())
        fail("{}: expected points below {}, found {} in triangle {}", name, mesh.points.size(), p, t);
    }
    for (const std::uint32_t m : mesh.sides[t]) {
      if (m >= mesh.materials.size())
        fail("{}: expected materials below {}, found {} at triangle {}", name, mesh.materials.size(), m, t);
    }
    const auto [front, back] = mesh.sides[t];
    result.triangles.push_back({mesh.triangles[t], MaterialId(front), MaterialId(back)});
  }
  return result;
}

}  // namespace adamas::inline core
