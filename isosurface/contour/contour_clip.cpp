#include "isosurface/contour/contour_clip.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/large_pages.h"
#include "core/lattice/diamond.h"

namespace adamas::isosurface {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

MeanPoint as_mean(const Contour& contour, std::uint32_t point) {
  const std::size_t edge_count = contour.edge_points.size();
  const std::size_t mean_begin = edge_count + contour.vertex_points.size();
  if (point >= mean_begin) return contour.mean_points[point - mean_begin];
  if (point >= edge_count) {
    const auto [vertex, step] = contour.vertex_points[point - edge_count];
    return {{vertex}, {1}, step};
  }
  const EdgePoint& p = contour.edge_points[point];
  return {{p.first, p.second}, {1 - p.parameter, p.parameter}, p.step()};
}

/// Returns the mean of two points of one tetrahedron. If a neighbour was merged with one of them, there may
/// be further vertices: the four with the greatest weights are kept.
MeanPoint between(const MeanPoint& a, const MeanPoint& b, double t) {
  std::array<std::pair<double, LatticePoint>, 8> parts;
  std::size_t count = 0;
  const auto add = [&](const MeanPoint& p, double weight) {
    for (std::size_t v = 0; v < 4; ++v) {
      if (p.weights[v] == 0) continue;
      std::size_t place = 0;
      while (place < count && parts[place].second != p.vertices[v]) ++place;
      if (place == count) parts[count++] = {0, p.vertices[v]};
      parts[place].first += weight * p.weights[v];
    }
  };
  add(a, 1 - t);
  add(b, t);
  double total = 1;
  if (count > 4) {
    std::stable_sort(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count),
                     [](const auto& x, const auto& y) { return x.first > y.first; });
    count = 4;
    total = parts[0].first + parts[1].first + parts[2].first + parts[3].first;
  }
  MeanPoint result;
  result.step = std::min(a.step, b.step);
  for (std::size_t v = 0; v < count; ++v) {
    result.vertices[v] = parts[v].second;
    result.weights[v] = parts[v].first / total;
  }
  return result;
}

/// A half space, which contains its plane.
class HalfSpace {
 public:
  /// Makes the half space before (beyond = 1) or behind (beyond = -1) a plane across an axis.
  HalfSpace(int axis, double plane, int beyond) : axis_(axis), plane_(beyond * plane) {
    normal_[axis] = beyond;
  }
  /// Makes the half space that the normal of a plane points away from. `tolerance`: the distance along each
  /// axis at which places count as equal.
  HalfSpace(const Plane& plane, const Vec3& tolerance)
      : normal_(normalized(plane.normal)), plane_(dot(normal_, plane.origin)) {
    constexpr double kRoundOff = 1e-12;
    near_ = kRoundOff * (norm(plane.origin) + norm(tolerance));
    for (int a = 0; a < 3; ++a) near_ += std::abs(normal_[a]) * tolerance[a];
  }

  /// Returns the axis that the plane is across; none where there is no such axis.
  [[nodiscard]] std::optional<int> axis() const { return axis_; }
  /// Returns the height of a point above the plane; 0 in it.
  [[nodiscard]] double height(const Vec3& p) const {
    if (axis_) return normal_[*axis_] * p[*axis_] - plane_;
    const double result = dot(normal_, p) - plane_;
    return std::abs(result) <= near_ ? 0 : result;
  }
  /// Returns the parameter, from 0 to 1, at which a line between points on both sides cuts the plane.
  [[nodiscard]] double cut(const Vec3& p, const Vec3& q) const {
    if (axis_) return (at() - p[*axis_]) / (q[*axis_] - p[*axis_]);
    const double from = height(p), to = height(q);
    return -from / (to - from);
  }
  /// Returns the point moved into a plane across an axis.
  [[nodiscard]] Vec3 on_plane(Vec3 point) const {
    if (axis_) point[*axis_] = at();
    return point;
  }

 private:
  [[nodiscard]] double at() const { return normal_[*axis_] * plane_; }

  std::optional<int> axis_;
  Vec3 normal_;
  double plane_ = 0, near_ = 0;
};

/// Computes the part of a contour in a half space.
class PlaneClip {
 public:
  /// Prepares the computation. `tolerance`: the distance along each axis at which places count as equal.
  PlaneClip(Contour& contour, const HalfSpace& inside, const Vec3& tolerance)
      : contour_(contour), inside_(inside), tolerance_(tolerance) {}

  void run() {
    if (inside_.axis() && tolerance_[*inside_.axis()] > 0) move_near_points(*inside_.axis());
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangles.swap(contour_.triangles);
    reserve_in_large_pages(contour_.triangles, triangles.size());
    reserve_in_large_pages(sides_, contour_.points.size());
    for (const Vec3& point : contour_.points) sides_.push_back(side_of(point));
    for (const auto& triangle : triangles) {
      if ((sides_[triangle[0]] & sides_[triangle[1]] & sides_[triangle[2]]) < 0) {
        contour_.triangles.push_back(triangle);
      } else {
        clip(triangle);
      }
    }
    if (!merged_.empty()) merge();
  }

 private:
  using Polygon = SmallList<std::uint32_t, 4>;

  /// Moves points near the plane into it. They are no longer on edges.
  void move_near_points(int axis) {
    const std::size_t edge_count = contour_.edge_points.size(), count = contour_.points.size();
    std::unordered_map<std::uint32_t, std::uint32_t> moved;
    for (std::size_t p = 0; p < count; ++p) {
      const double height = inside_.height(contour_.points[p]);
      if (height == 0 || !(std::abs(height) <= tolerance_[axis])) continue;
      const Vec3 point = inside_.on_plane(contour_.points[p]);
      if (p >= edge_count) {
        contour_.points[p] = point;
      } else {
        const auto number = static_cast<std::uint32_t>(p);
        moved.emplace(number, add(point, as_mean(contour_, number)));
      }
    }
    if (moved.empty()) return;
    for (auto& triangle : contour_.triangles) {
      for (std::uint32_t& p : triangle) {
        const auto found = moved.find(p);
        if (found != moved.end()) p = found->second;
      }
    }
  }

  /// Returns -1 for a point inside, 0 on the plane, 1 beyond it.
  [[nodiscard]] std::int8_t side_of(const Vec3& point) const {
    const double height = inside_.height(point);
    return static_cast<std::int8_t>(static_cast<int>(height > 0) - static_cast<int>(height < 0));
  }
  [[nodiscard]] int side(std::uint32_t point) const { return sides_[point]; }

  void clip(const std::array<std::uint32_t, 3>& triangle) {
    const std::array<int, 3> sides{side(triangle[0]), side(triangle[1]), side(triangle[2])};
    const auto [least, greatest] = std::minmax_element(sides.begin(), sides.end());
    Polygon polygon;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t next = (c + 1) % 3;
      if (sides[c] <= 0) polygon.push_back(triangle[c]);
      if (*greatest > 0 && *least < 0 && sides[c] * sides[next] < 0)
        polygon.push_back(cut(triangle[c], triangle[next]));
    }
    // A triangle that only touches the plane from beyond has no part inside.
    if (*greatest > 0 && *least >= 0) return;
    if (*greatest >= 0 && norm(tolerance_) > 0) note_near_points(polygon);
    for (std::size_t c = 2; c < polygon.size(); ++c)
      contour_.triangles.push_back({polygon[0], polygon[c - 1], polygon[c]});
  }

  /// Returns the point of an edge in the plane, which is the same for both of its triangles.
  std::uint32_t cut(std::uint32_t a, std::uint32_t b) {
    if (b < a) std::swap(a, b);
    const auto [entry, is_new] = cuts_.try_emplace(std::uint64_t{a} << 32 | b, kNone);
    if (is_new) {
      const Vec3 p = contour_.points[a], q = contour_.points[b];
      const double t = inside_.cut(p, q);
      entry->second = add(inside_.on_plane(point_between(p, q, t)),
                          between(as_mean(contour_, a), as_mean(contour_, b), t));
      sides_.push_back(side_of(contour_.points.back()));
    }
    return entry->second;
  }

  std::uint32_t add(const Vec3& point, const MeanPoint& mean) {
    if (contour_.points.size() >= kNone) fail("a contour has more than 2^32 - 1 points at the data's border");
    contour_.mean_points.push_back(mean);
    contour_.points.push_back(point);
    return static_cast<std::uint32_t>(contour_.points.size() - 1);
  }

  /// Merges neighbours in the plane that are near each other.
  void note_near_points(const Polygon& polygon) {
    for (std::size_t c = 0; c < polygon.size(); ++c) {
      const std::uint32_t a = polygon[c], b = polygon[(c + 1) % polygon.size()];
      if (side(a) != 0 || side(b) != 0) continue;
      const Vec3 way = contour_.points[b] - contour_.points[a];
      bool is_near = true;
      for (int axis = 0; axis < 3; ++axis) is_near = is_near && std::abs(way[axis]) <= tolerance_[axis];
      const std::uint32_t first = std::min(kept(a), kept(b)), second = std::max(kept(a), kept(b));
      if (is_near && first != second) merged_[second] = first;
    }
  }

  /// Returns the point that a point was merged into, or the point itself.
  [[nodiscard]] std::uint32_t kept(std::uint32_t point) const {
    for (auto found = merged_.find(point); found != merged_.end(); found = merged_.find(point))
      point = found->second;
    return point;
  }

  void merge() {
    for (auto& triangle : contour_.triangles) {
      for (std::uint32_t& p : triangle) p = kept(p);
    }
    std::erase_if(contour_.triangles,
                  [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  }

  Contour& contour_;
  const HalfSpace& inside_;
  Vec3 tolerance_;
  std::vector<std::int8_t> sides_;                           ///< indexed by point
  std::unordered_map<std::uint64_t, std::uint32_t> cuts_;    ///< indexed by the two points of an edge
  std::unordered_map<std::uint32_t, std::uint32_t> merged_;  ///< merged points, and the lesser point of each
};

/// Returns the distance along an axis at which places count as equal: some units in the last place of single
/// precision, with which surfaces are written, but more than the rounding errors of sample places in double
/// precision.
double tolerance_at(double place, double spacing) {
  return std::clamp(std::ldexp(std::abs(place), -21), std::ldexp(spacing, -30), std::ldexp(spacing, -13));
}

Vec3 tolerance_in(const Box3& box, const Vec3& spacing) {
  Vec3 result;
  for (int axis = 0; axis < 3; ++axis)
    result[axis] = tolerance_at(std::max(std::abs(box.min[axis]), std::abs(box.max[axis])), spacing[axis]);
  return result;
}

Box3 box_of(const std::vector<Vec3>& points) {
  Box3 box;
  for (const Vec3& p : points) box.extend(p);
  return box;
}

void clip_by(const std::vector<HalfSpace>& sides, const Vec3& tolerance, Contour& contour) {
  bool clipped = false;
  // Clipping adds no point outside of this box.
  const Box3 reach = box_of(contour.points);
  for (const HalfSpace& side : sides) {
    if (side.axis() && side.height(reach.min) <= 0 && side.height(reach.max) <= 0) continue;
    const auto is_outside = [&side](const Vec3& p) { return side.height(p) > 0; };
    if (std::none_of(contour.points.begin(), contour.points.end(), is_outside)) continue;
    PlaneClip(contour, side, tolerance).run();
    clipped = true;
  }
  if (clipped) remove_unused_points(contour);
}

}  // namespace

void clip_contour(Contour& contour, const Box3& box, const Vec3& spacing) {
  std::vector<HalfSpace> sides;
  for (int axis = 0; axis < 3; ++axis) {
    sides.emplace_back(axis, box.max[axis], 1);
    sides.emplace_back(axis, box.min[axis], -1);
  }
  clip_by(sides, tolerance_in(box, spacing), contour);
}

void clip_contour(Contour& contour, std::span<const Plane> sides, const Vec3& spacing) {
  if (sides.empty()) return;
  const Box3 box = box_of(contour.points);
  const Vec3 tolerance = contour.points.empty() ? Vec3{} : tolerance_in(box, spacing);
  std::vector<HalfSpace> all;
  for (const Plane& side : sides) all.emplace_back(side, tolerance);
  clip_by(all, tolerance, contour);
}

}  // namespace adamas::isosurface
