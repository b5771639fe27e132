#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/geometry/vec3.h"
#include "isosurface/view/viewpoint.h"
#include "viewer/document/drawn_mesh.h"

namespace adamas::viewer {

/// Whether triangles of a part mix with what lies behind them.
inline bool is_transparent(const DrawnPart& part) { return part.style.opacity < 1 && !part.mesh->is_lines; }

/// Triangles of transparent parts, from far to near.
class SortedTriangles {
 public:
  SortedTriangles(std::span<const DrawnPart> parts, const isosurface::Viewpoint& viewpoint) {
    const Vec3 forward = normalized(viewpoint.target - viewpoint.eye);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (!is_transparent(parts[p])) continue;
      const DrawnMesh& mesh = *parts[p].mesh;
      const auto origin = static_cast<float>(dot(mesh.origin - viewpoint.eye, forward));
      for (std::size_t t = 0; 3 * t + 2 < mesh.indices.size(); ++t) {
        float depth = 3 * origin;
        for (std::size_t c = 0; c < 3; ++c) {
          const Vec3 place = mesh.place(mesh.indices[3 * t + c], parts[p].isovalue);
          depth += static_cast<float>(dot(forward, place));
        }
        triangles_.push_back({depth, static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(t)});
      }
    }
    std::ranges::stable_sort(triangles_, std::greater<>{}, &Triangle::depth);
  }

  struct Triangle {
    float depth;
    std::uint32_t part, triangle;
  };
  [[nodiscard]] const std::vector<Triangle>& all() const { return triangles_; }

 private:
  std::vector<Triangle> triangles_;
};

}  // namespace adamas::viewer
