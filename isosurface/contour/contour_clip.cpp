#include "isosurface/contour/contour_clip.h"

#include <algorithm>
#include <cstdint>
#include <limits>
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

/// The part of a contour before (beyond = 1) or behind (beyond = -1) a plane across an axis.
class PlaneClip {
 public:
  PlaneClip(Contour& contour, int axis, double plane, int beyond)
      : contour_(contour), axis_(axis), plane_(plane), beyond_(beyond) {}

  void run() {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangles.swap(contour_.triangles);
    for (const auto& triangle : triangles) clip(triangle);
  }

 private:
  /// -1 inside, 0 on the plane, 1 beyond it.
  [[nodiscard]] int side(std::uint32_t point) const {
    const double x = contour_.points[point][axis_];
    return beyond_ * (static_cast<int>(x > plane_) - static_cast<int>(x < plane_));
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
      const double t = (plane_ - p[axis_]) / (q[axis_] - p[axis_]);
      Vec3 point = point_between(p, q, t);
      point[axis_] = plane_;
      contour_.border_points.push_back(between(as_mean(contour_, a), as_mean(contour_, b), t));
      contour_.points.push_back(point);
    }
    return entry->second;
  }

  Contour& contour_;
  int axis_;
  double plane_;
  int beyond_;
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

}  // namespace

void clip_contour(Contour& contour, const Box3& box) {
  bool clipped = false;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int beyond : {1, -1}) {
      const double plane = beyond > 0 ? box.max[axis] : box.min[axis];
      const auto outside = [&](const Vec3& p) { return beyond * p[axis] > beyond * plane; };
      if (std::none_of(contour.points.begin(), contour.points.end(), outside)) continue;
      PlaneClip(contour, axis, plane, beyond).run();
      clipped = true;
    }
  }
  if (clipped) remove_unused_points(contour);
}

}  // namespace adamas
