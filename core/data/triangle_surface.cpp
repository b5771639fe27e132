#include <algorithm>
#include <cmath>

#include "adamas/geometry.h"
#include "adamas/meshes.h"
#include "core/base/error.h"

namespace adamas {

namespace {

void check_finite(const std::string& name, const char* what, const std::vector<Vec3>& vectors) {
  const auto odd = std::find_if_not(vectors.begin(), vectors.end(), is_finite);
  if (odd == vectors.end()) return;
  fail("{}: expected finite {}, found {} {} {} at point {}", name, what, odd->x, odd->y, odd->z,
       odd - vectors.begin());
}

void check_count(const std::string& name, const char* what, std::size_t count, std::size_t points) {
  if (count == 0 || count == points) return;
  fail("{}: expected none or {} {}, one for each point, found {}", name, points, what, count);
}

}  // namespace

void TriangleSurface::check(const std::string& name) const {
  check_count(name, "normals", normals.size(), points.size());
  check_count(name, "values", values.size(), points.size());
  check_finite(name, "coordinates", points);
  check_finite(name, "normals", normals);
  const auto odd = std::find_if_not(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
  if (odd != values.end()) {
    fail("{}: expected finite values, found {} at point {}", name, *odd, odd - values.begin());
  }
  for (const auto& corners : triangles) {
    const std::uint32_t greatest = std::max({corners[0], corners[1], corners[2]});
    if (greatest >= points.size()) {
      fail("{}: expected triangles on {} points, found one with point {}", name, points.size(), greatest);
    }
  }
}

}  // namespace adamas
