#include "isosurface/contour/contour_clip.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/lattice/diamond.h"
#include "isosurface/contour/point_between.h"

namespace adamas {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

BorderPoint as_mean(const Contour& contour, std::uint32_t point) {
  const std::size_t edge_count = contour.edge_points.size();
  if (point >= edge_count) return contour.border_points[point - edge_count];
  const EdgePoint& p = contour.edge_points[point];
  return {{p.first, p.second, p.first, p.first}, {1 - p.parameter, p.parameter, 0, 0}};
}

/// The mean of two points of one tetrahedron.
BorderPoint between(const BorderPoint& a, const BorderPoint& b, double t) {
  BorderPoint result;
  std::size_t count = 0;
  const auto add = [&](const BorderPoint& p, double weight) {
    for (std::size_t v = 0; v < 4; ++v) {
      if (p.weights[v] == 0) continue;
      const auto begin = result.vertices.begin(), end = begin + static_cast<std::ptrdiff_t>(count);
      const auto place = static_cast<std::size_t>(std::find(begin, end, p.vertices[v]) - begin);
      ADAMAS_ASSERT(place < 4);
      if (place == count) result.vertices[count++] = p.vertices[v];
      result.weights[place] += weight * p.weights[v];
    }
  };
  add(a, 1 - t);
  add(b, t);
  return result;
}

/// A half space: what is not higher than a plane.
class HalfSpace {
 public:
  /// Before (beyond = 1) or behind (beyond = -1) a plane across an axis, in which cut points lie exactly.
  HalfSpace(int axis, double plane, int beyond) : axis_(axis), plane_(beyond * plane) {
    normal_[axis] = beyond;
  }
  explicit HalfSpace(const Plane& plane) : normal_(plane.normal), plane_(dot(plane.normal, plane.origin)) {}

  /// Above the plane.
  [[nodiscard]] double height(const Vec3& p) const {
    return (axis_ ? normal_[*axis_] * p[*axis_] : dot(normal_, p)) - plane_;
  }
  /// Where a line between a point inside and one beyond cuts the plane: a part of the way.
  [[nodiscard]] double cut(const Vec3& p, const Vec3& q) const {
    const double from = height(p), to = height(q);
    return -from / (to - from);
  }
  [[nodiscard]] Vec3 on_plane(Vec3 point) const {
    if (axis_) point[*axis_] = normal_[*axis_] * plane_;
    return point;
  }

 private:
  std::optional<int> axis_;
  Vec3 normal_;
  double plane_;
};

/// The part of a contour in a half space.
class PlaneClip {
 public:
  PlaneClip(Contour& contour, const HalfSpace& inside) : contour_(contour), inside_(inside) {}

  void run() {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangles.swap(contour_.triangles);
    for (const auto& triangle : triangles) clip(triangle);
  }

 private:
  /// -1 inside, 0 on the plane, 1 beyond it.
  [[nodiscard]] int side(std::uint32_t point) const {
    const double height = inside_.height(contour_.points[point]);
    return static_cast<int>(height > 0) - static_cast<int>(height < 0);
  }

  void clip(const std::array<std::uint32_t, 3>& triangle) {
    const std::array<int, 3> sides{side(triangle[0]), side(triangle[1]), side(triangle[2])};
    const auto [least, greatest] = std::minmax_element(sides.begin(), sides.end());
    if (*greatest <= 0) contour_.triangles.push_back(triangle);
    // What only touches the plane from beyond has no part inside.
    if (*greatest <= 0 || *least >= 0) return;
    SmallList<std::uint32_t, 4> polygon;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t next = (c + 1) % 3;
      if (sides[c] <= 0) polygon.push_back(triangle[c]);
      if (sides[c] * sides[next] < 0) polygon.push_back(cut(triangle[c], triangle[next]));
    }
    for (std::size_t c = 2; c < polygon.size(); ++c)
      contour_.triangles.push_back({polygon[0], polygon[c - 1], polygon[c]});
  }

  /// The point of an edge in the plane: the same from both of its triangles.
  std::uint32_t cut(std::uint32_t a, std::uint32_t b) {
    if (b < a) std::swap(a, b);
    const auto [entry, is_new] = cuts_.try_emplace(std::uint64_t{a} << 32 | b, kNone);
    if (is_new) {
      if (contour_.points.size() >= kNone)
        fail("a contour has more than 2^32 - 1 points at the data's border");
      entry->second = static_cast<std::uint32_t>(contour_.points.size());
      const Vec3 p = contour_.points[a], q = contour_.points[b];
      const double t = inside_.cut(p, q);
      contour_.border_points.push_back(between(as_mean(contour_, a), as_mean(contour_, b), t));
      contour_.points.push_back(inside_.on_plane(point_between(p, q, t)));
    }
    return entry->second;
  }

  Contour& contour_;
  const HalfSpace& inside_;
  std::unordered_map<std::uint64_t, std::uint32_t> cuts_;  ///< by the two points of an edge
};

/// Keeps the points of triangles, in their order.
void remove_unused_points(Contour& contour) {
  std::vector<std::uint32_t> numbers(contour.points.size(), kNone);
  for (const auto& triangle : contour.triangles) {
    for (const std::uint32_t p : triangle) numbers[p] = 0;
  }
  Contour kept;
  const std::size_t edge_count = contour.edge_points.size();
  for (std::size_t p = 0; p < numbers.size(); ++p) {
    if (numbers[p] == kNone) continue;
    numbers[p] = static_cast<std::uint32_t>(kept.points.size());
    kept.points.push_back(contour.points[p]);
    if (p < edge_count) {
      kept.edge_points.push_back(contour.edge_points[p]);
    } else {
      kept.border_points.push_back(contour.border_points[p - edge_count]);
    }
  }
  for (auto& triangle : contour.triangles) {
    for (std::uint32_t& p : triangle) p = numbers[p];
  }
  kept.triangles.swap(contour.triangles);
  contour = std::move(kept);
}

void clip_by(const std::vector<HalfSpace>& sides, Contour& contour) {
  bool clipped = false;
  for (const HalfSpace& side : sides) {
    const auto is_outside = [&side](const Vec3& p) { return side.height(p) > 0; };
    if (std::none_of(contour.points.begin(), contour.points.end(), is_outside)) continue;
    PlaneClip(contour, side).run();
    clipped = true;
  }
  if (clipped) remove_unused_points(contour);
}

}  // namespace

void clip_contour(Contour& contour, const Box3& box) {
  std::vector<HalfSpace> sides;
  for (int axis = 0; axis < 3; ++axis) {
    sides.emplace_back(axis, box.max[axis], 1);
    sides.emplace_back(axis, box.min[axis], -1);
  }
  clip_by(sides, contour);
}

void clip_contour(Contour& contour, std::span<const Plane> sides) {
  clip_by({sides.begin(), sides.end()}, contour);
}

}  // namespace adamas
