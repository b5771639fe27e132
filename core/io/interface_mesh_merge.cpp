#include <algorithm>
#include <bit>
#include <unordered_map>

#include "core/base/hash.h"
#include "core/io/interface_mesh_io.h"

namespace adamas::io {

namespace {

struct PointHash {
  std::size_t operator()(const Vec3& p) const {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      // -0 equals 0, so both get one hash.
      hash = hash_combine(hash, std::bit_cast<std::uint64_t>(p[axis] + 0.0));
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash);
  }
};

}  // namespace

void weld(InterfaceMesh& mesh) {
  std::unordered_map<Vec3, std::uint32_t, PointHash> found;
  found.reserve(mesh.points.size());
  std::vector<std::uint32_t> target(mesh.points.size());
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const auto [at, added] = found.try_emplace(mesh.points[i], static_cast<std::uint32_t>(points.size()));
    if (added) points.push_back(mesh.points[i]);
    target[i] = at->second;
  }
  mesh.points = std::move(points);
  std::vector<InterfaceTriangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (InterfaceTriangle triangle : mesh.triangles) {
    for (std::uint32_t& p : triangle.points) p = target[p];
    const auto& [a, b, c] = triangle.points;
    if (a != b && b != c && c != a) triangles.push_back(triangle);
  }
  mesh.triangles = std::move(triangles);
}

InterfaceMesh merge(std::span<const InterfaceMesh> meshes) {
  InterfaceMesh result;
  for (const InterfaceMesh& mesh : meshes) {
    result.source += (result.source.empty() ? "" : ", ") + mesh.source;
    IdVector<MaterialId, MaterialId> materials;
    for (const std::string& name : mesh.materials) {
      const auto at = std::find(result.materials.begin(), result.materials.end(), name);
      materials.push_back(MaterialId(static_cast<std::size_t>(at - result.materials.begin())));
      if (at == result.materials.end()) result.materials.push_back(name);
    }
    const auto first = static_cast<std::uint32_t>(result.points.size());
    result.points.insert(result.points.end(), mesh.points.begin(), mesh.points.end());
    for (InterfaceTriangle triangle : mesh.triangles) {
      for (std::uint32_t& p : triangle.points) p += first;
      triangle.front = materials[triangle.front];
      triangle.back = materials[triangle.back];
      result.triangles.push_back(triangle);
    }
  }
  weld(result);
  return result;
}

}  // namespace adamas::io
