#include "core/geometry/plane_sides.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/error.h"

namespace adamas::inline core {

namespace {

double greatest(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Corners of the sides of a box, counter-clockwise seen from outside.
constexpr std::array<std::array<std::uint8_t, 4>, 6> kSides{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

/// The number of the edge between two corners: the axis, and its lower end without that axis' bit.
std::size_t edge_between(std::size_t a, std::size_t b) {
  const std::size_t bit = a ^ b, low = std::min(a, b);
  const std::size_t axis = bit >> 1;
  return 8 * axis + low;
}

}  // namespace

PlaneSides::PlaneSides(const Plane& plane, const Box3& box, std::string_view source) : plane_(plane) {
  if (!is_finite(plane.origin) || !is_finite(plane.normal))
    fail("{}: plane: expected finite numbers, found {}", source, to_string(plane));
  const double length = greatest(plane.normal);
  if (!(length > 0)) fail("{}: plane: expected a normal that is not zero, found (0, 0, 0)", source);
  normal_ = normalized({plane.normal.x / length, plane.normal.y / length, plane.normal.z / length});
  tolerance_ = 16 * std::numeric_limits<double>::epsilon() *
               std::max({greatest(box.min), greatest(box.max), greatest(plane.origin)});
  if (const auto axis = plane.axis()) {
    // This is a bound for the rounding of the difference of two coordinates.
    tolerance_ = 4 * std::numeric_limits<double>::epsilon() *
                 std::max(std::abs(box.min[*axis]), std::abs(box.max[*axis]));
  }
  std::size_t below = 0, in_plane = 0;
  for (unsigned c = 0; c < 8; ++c) {
    const double d = distance(box.corner(c));
    if (d < 0) ++below;
    if (d == 0) ++in_plane;
  }
  zero_above_ = below > 0;
  // If no corners lie on both sides, the plane must contain a whole side of the box.
  const bool cuts = below > 0 && below + in_plane < 8;
  if (!cuts && in_plane < 4) {
    fail("{}: plane: expected one that cuts the domain from ({}, {}, {}) to ({}, {}, {}), found {}", source,
         box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z, to_string(plane));
  }
}

std::array<double, 2> PlaneSides::bounds_along(int axis, const Box3& box) const {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  const double margin = 4096 * tolerance_;
  double low = -margin, high = margin;
  for (int a = 0; a < 3; ++a) {
    if (a == axis) continue;
    const auto [least, most] = std::minmax(
        {normal_[a] * (box.min[a] - plane_.origin[a]), normal_[a] * (box.max[a] - plane_.origin[a])});
    low += least, high += most;
  }
  if (normal_[axis] == 0) {
    if (low <= 0 && high >= 0) return {-kEndless, kEndless};
    return {kEndless, -kEndless};
  }
  const auto [from, to] =
      std::minmax({plane_.origin[axis] - low / normal_[axis], plane_.origin[axis] - high / normal_[axis]});
  return {from, to};
}

void cut_box(const PlaneSides& sides, const Box3& box, std::vector<Vec3>& corners) {
  constexpr std::size_t kNone = 24;
  corners.clear();
  std::array<double, 8> d{};
  std::array<bool, 8> above{};
  std::size_t count = 0;
  for (unsigned c = 0; c < 8; ++c) {
    d[c] = sides.distance(box.corner(c));
    above[c] = sides.above(d[c]);
    count += above[c] ? 1 : 0;
  }
  if (count == 0 || count == 8) return;
  // On each side of the box that is cut, the path that has the upper part on its left leads from one edge to
  // another.
  std::array<std::size_t, kNone> next{};
  next.fill(kNone);
  std::size_t first = kNone;
  for (const auto& side : kSides) {
    std::size_t from = kNone, to = kNone;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t a = side[i], b = side[(i + 1) % 4];
      if (above[a] == above[b]) continue;
      (above[a] ? to : from) = edge_between(a, b);
    }
    if (from != kNone) next[to] = from, first = to;
  }
  std::size_t edge = first;
  do {
    const auto low = static_cast<unsigned>(edge % 8), high = low | (1u << (edge / 8));
    const Vec3 p = PlaneSides::crossing(box.corner(low), d[low], box.corner(high), d[high]);
    if (corners.empty() || !(p == corners.back())) corners.push_back(p);
    edge = next[edge];
  } while (edge != first);
  if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  if (corners.size() < 3) corners.clear();
}

}  // namespace adamas::inline core
