#include "tests/support/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace adamas::test {

namespace {

double squared_distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a, from = p - a;
  const double length = squared_norm(along), at = dot(from, along);
  if (at <= 0 || length <= 0) return squared_norm(from);
  return squared_norm(from - std::min(at / length, 1.0) * along);
}

}  // namespace

double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = cross(b - a, c - a);
  const bool above = dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
                     dot(cross(a - c, p - c), n) >= 0 && squared_norm(n) > 0;
  if (above) return std::abs(dot(p - a, n)) / norm(n);
  return std::sqrt(std::min({squared_distance_to_segment(p, a, b), squared_distance_to_segment(p, b, c),
                             squared_distance_to_segment(p, c, a)}));
}

SurfaceGrid::SurfaceGrid(const std::vector<Vec3>& points, const std::vector<TriangleIndices>& triangles) {
  for (const TriangleIndices& t : triangles) {
    corners_.push_back({points[t[0]], points[t[1]], points[t[2]]});
    for (const Vec3& p : corners_.back()) box_.extend(p);
  }
  if (corners_.empty()) return;
  const Vec3 size = box_.size();
  const double longest = std::max({size.x, size.y, size.z});
  const double along = std::clamp(std::sqrt(static_cast<double>(corners_.size())), 1.0, 48.0);
  side_ = longest > 0 ? longest / along : 1;
  for (int axis = 0; axis < 3; ++axis)
    count_[static_cast<std::size_t>(axis)] = 1 + static_cast<int>(size[axis] / side_);
  boxes_.resize(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) *
                static_cast<std::size_t>(count_[2]));
  for (std::uint32_t t = 0; t < corners_.size(); ++t) {
    Box3 bounds;
    for (const Vec3& p : corners_[t]) bounds.extend(p);
    const Index low = index_of(bounds.min), high = index_of(bounds.max);
    for (int k = low[2]; k <= high[2]; ++k) {
      for (int j = low[1]; j <= high[1]; ++j) {
        for (int i = low[0]; i <= high[0]; ++i) {
          // Boxes that the triangle surely misses are left out.
          const Vec3 center = box_.min + side_ * Vec3{i + 0.5, j + 0.5, k + 0.5};
          const auto& c = corners_[t];
          if (distance_to_triangle(center, c[0], c[1], c[2]) <= 0.8661 * side_)
            boxes_[slot({i, j, k})].push_back(t);
        }
      }
    }
  }
}

SurfaceGrid::Index SurfaceGrid::index_of(const Vec3& p) const {
  Index index{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double at = std::clamp((p[axis] - box_.min[axis]) / side_, 0.0, static_cast<double>(count_[a] - 1));
    index[a] = static_cast<int>(at);
  }
  return index;
}

std::size_t SurfaceGrid::slot(const Index& i) const {
  return static_cast<std::size_t>(i[0] + count_[0] * (i[1] + count_[1] * i[2]));
}

double SurfaceGrid::distance_to_box(const Vec3& p, const Index& i) const {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box_.min[axis] + side_ * i[static_cast<std::size_t>(axis)];
    // The margin covers what round-off may do to the boxes.
    const double outside = std::max(low - p[axis], p[axis] - low - side_) - 1e-9 * side_;
    if (outside > 0) sum += outside * outside;
  }
  return std::sqrt(sum);
}

double SurfaceGrid::distance(const Vec3& p) const {
  double best = std::numeric_limits<double>::infinity();
  if (corners_.empty()) return best;
  const Index middle = index_of(p);
  const int most = std::max({count_[0], count_[1], count_[2]});
  // Boxes are tried shell by shell. Those of shell r are at least r - 1 sides away, and farther where p lies
  // outside.
  for (int r = 0; r < most && (r < 2 || best > (r - 1) * side_); ++r) {
    for (int k = std::max(middle[2] - r, 0); k <= std::min(middle[2] + r, count_[2] - 1); ++k) {
      for (int j = std::max(middle[1] - r, 0); j <= std::min(middle[1] + r, count_[1] - 1); ++j) {
        const bool whole = std::abs(k - middle[2]) == r || std::abs(j - middle[1]) == r;
        for (int i = middle[0] - r; i <= middle[0] + r; i += whole || r == 0 ? 1 : 2 * r) {
          if (i < 0 || i >= count_[0] || distance_to_box(p, {i, j, k}) > best) continue;
          for (const std::uint32_t t : boxes_[slot({i, j, k})]) {
            const auto& c = corners_[t];
            best = std::min(best, distance_to_triangle(p, c[0], c[1], c[2]));
          }
        }
      }
    }
  }
  return best;
}

std::vector<Vec3> sample_surface(const std::vector<Vec3>& points,
                                 const std::vector<TriangleIndices>& triangles, const Box3& box,
                                 std::size_t count, std::uint64_t seed) {
  std::vector<Vec3> result;
  std::vector<double> areas;
  std::vector<bool> seen(points.size());
  for (const TriangleIndices& t : triangles) {
    areas.push_back(norm(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]])));
    for (const std::uint32_t p : t) {
      if (!seen[p] && box.contains(points[p])) result.push_back(points[p]);
      seen[p] = true;
    }
  }
  if (triangles.empty()) return result;
  std::mt19937_64 random(seed);
  std::discrete_distribution<std::size_t> choose(areas.begin(), areas.end());
  std::uniform_real_distribution<double> unit(0, 1);
  for (std::size_t i = 0; i < count; ++i) {
    const TriangleIndices& t = triangles[choose(random)];
    double u = unit(random), v = unit(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3 p = (1 - u - v) * points[t[0]] + u * points[t[1]] + v * points[t[2]];
    if (box.contains(p)) result.push_back(p);
  }
  return result;
}

double sampled_distance(const std::vector<Vec3>& points_a, const std::vector<TriangleIndices>& triangles_a,
                        const std::vector<Vec3>& points_b, const std::vector<TriangleIndices>& triangles_b,
                        const Box3& box, std::size_t count, std::uint64_t seed) {
  const SurfaceGrid a(points_a, triangles_a), b(points_b, triangles_b);
  double greatest = 0;
  for (const Vec3& p : sample_surface(points_a, triangles_a, box, count, seed))
    greatest = std::max(greatest, b.distance(p));
  for (const Vec3& p : sample_surface(points_b, triangles_b, box, count, seed + 1))
    greatest = std::max(greatest, a.distance(p));
  return greatest;
}

}  // namespace adamas::test
