#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/geometry/vec3.h"

namespace adamas {

/// Triangulates a (weakly) convex polygon, given by indices into `points`, by cutting off the best-shaped ear
/// again and again; collinear corners make no triangle without area unless all are collinear. `emit(a, b, c)`
/// keeps orientation.
template <class Emit>
void triangulate_convex(const std::vector<Vec3>& points, std::vector<std::uint32_t> loop, Emit&& emit) {
  const auto quality = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vec3 u = points[b] - points[a], v = points[c] - points[b], w = points[a] - points[c];
    const double longest = std::max({squared_norm(u), squared_norm(v), squared_norm(w)});
    return longest > 0 ? norm(cross(u, v)) / longest : 0;
  };
  while (loop.size() > 3) {
    const std::size_t n = loop.size();
    std::size_t best = 0;
    double best_quality = -1;
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t a = loop[(i + n - 1) % n], b = loop[i], c = loop[(i + 1) % n];
      // The ear's own shape and, for quadrilaterals, the shape of what is left.
      double q = quality(a, b, c);
      if (n == 4) q = std::min(q, quality(a, c, loop[(i + 2) % n]));
      if (q > best_quality) best = i, best_quality = q;
    }
    emit(loop[(best + n - 1) % n], loop[best], loop[(best + 1) % n]);
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(best));
  }
  if (loop.size() == 3) emit(loop[0], loop[1], loop[2]);
}

}  // namespace adamas
