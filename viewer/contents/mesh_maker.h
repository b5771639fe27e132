#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "viewer/contents/drawn_mesh.h"

namespace adamas::viewer {

/// Collects the vertices and indices of a DrawnMesh.
class MeshMaker {
 public:
  enum class Kind : std::uint8_t { kTriangles, kLines };
  MeshMaker(const Vec3& origin, Kind kind);

  /// The values on the two sides of a vertex, NaN if there are none.
  struct Values {
    double front = std::numeric_limits<double>::quiet_NaN(), back = std::numeric_limits<double>::quiet_NaN();
  };
  /// Adds a vertex at a place in space. Returns its number.
  std::uint32_t add_vertex(const Vec3& place, const Vec3& normal, const Values& values);
  void add_index(std::uint32_t vertex) { mesh_.indices.push_back(vertex); }
  /// Returns the mesh, or null if it has no triangles or lines. The maker is empty afterwards.
  SharedMesh finish();

 private:
  DrawnMesh mesh_;
};

/// A number and what it counts, as "1,234 triangles" or "1 triangle".
std::string counted(std::size_t count, std::string_view one, std::string_view several);

}  // namespace adamas::viewer
