#include "core/geometry/plane.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/geometry/box_clip.h"

namespace adamas::inline core {

namespace {

/// The unit vector, also for lengths whose square overflows or underflows.
Vec3 direction(const Vec3& v) {
  const double greatest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return normalized({v.x / greatest, v.y / greatest, v.z / greatest});
}

}  // namespace

}  // namespace adamas::inline core

namespace adamas {

std::optional<int> Plane::axis() const {
  std::optional<int> found;
  for (int a = 0; a < 3; ++a) {
    if (normal[a] == 0) continue;
    if (found) return std::nullopt;
    found = a;
  }
  return found;
}

Plane parse_plane(std::string_view text) {
  const auto bad = [&]() { fail("plane: expected x=NUMBER, y=NUMBER or z=NUMBER, found '{}'", text); };
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) bad();
  const std::string_view name = trimmed(text.substr(0, equals));
  std::string_view number = trimmed(text.substr(equals + 1));
  if (name.size() != 1 || name[0] < 'x' || name[0] > 'z') bad();
  if (number.starts_with('+') && !number.starts_with("+-")) number.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || end != number.data() + number.size() || !std::isfinite(value)) bad();
  Plane plane;
  plane.origin[name[0] - 'x'] = value;
  plane.normal[name[0] - 'x'] = 1;
  return plane;
}

std::string to_string(const Plane& plane) {
  if (const auto axis = plane.axis()) return fmt::format("{}={}", "xyz"[*axis], plane.origin[*axis]);
  const Vec3 &o = plane.origin, &n = plane.normal;
  return fmt::format("through ({}, {}, {}) with normal ({}, {}, {})", o.x, o.y, o.z, n.x, n.y, n.z);
}

}  // namespace adamas

namespace adamas::inline core {

PlaneFrame plane_frame(const Plane& plane) {
  if (const auto axis = plane.axis()) {
    const int a = *axis == 0 ? 1 : 0, b = *axis == 2 ? 1 : 2;
    PlaneFrame frame{{}, {}, {}, std::string(1, "xyz"[a]), std::string(1, "xyz"[b])};
    frame.right[a] = 1;
    frame.up[b] = 1;
    return frame;
  }
  const Vec3 normal = direction(plane.normal);
  const Vec3 high = std::abs(normal.z) < 0.99 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
  const Vec3 up = direction(high - dot(high, normal) * normal);
  return {plane.origin, cross(up, normal), up, "u", "v"};
}

std::vector<Vec3> clip_plane(const Plane& plane, const Box3& box) {
  const Vec3 normal = direction(plane.normal), center = box.center();
  // This is the plane's point nearest to the box's centre; its own coordinate along an axis is exact.
  Vec3 middle = center - dot(normal, center - plane.origin) * normal;
  if (const auto axis = plane.axis()) middle[*axis] = plane.origin[*axis];
  const double reach = box.diagonal();
  if (!(distance(middle, center) <= reach)) return {};
  const PlaneFrame frame = plane_frame(plane);
  const Vec3 u = reach * frame.right, v = reach * frame.up;
  std::vector<Vec3> polygon{middle - u - v, middle + u - v, middle + u + v, middle - u + v};
  std::vector<Vec3> scratch;
  clip_to_box(polygon, box, scratch);
  return polygon;
}

double polygon_area(const std::vector<Vec3>& corners) {
  Vec3 sum;
  for (std::size_t i = 2; i < corners.size(); ++i)
    sum += cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
  return 0.5 * norm(sum);
}

}  // namespace adamas::inline core
