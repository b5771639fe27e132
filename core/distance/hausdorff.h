#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/distance/closest_point_tree.h"

namespace adamas::inline core {

struct HausdorffOptions {
  /// The search stops where upper <= (1 + relative) * lower, `lower` being the greatest lower bound of all
  /// triangles.
  double relative = 0.05;
  /// Triangles within this distance are not examined more closely; 0 stands for 1e-4 of the size of the
  /// target.
  double accept = 0;
  /// Whether the distance of each triangle is bounded that tightly, not only the greatest of all.
  bool each = false;
  /// Only the parts of triangles inside this box count.
  std::optional<Box3> domain;
  /// The greatest number of pieces that are examined; triangles that are not finished by then keep a looser
  /// bound.
  std::size_t most_pieces = 50'000'000;
};

/// Bounds of the directed Hausdorff distance: the greatest distance of a point of one surface to another
/// surface.
struct DistanceBound {
  double upper = 0;  ///< never below the distance
  double lower = 0;  ///< the distance at `worst`; 0 if no triangle had to be examined
  Vec3 worst;
  /// Per triangle of the list: no point of it is farther; 0 outside the domain.
  std::vector<double> triangle_upper;
  /// Per triangle of the list, if each was bounded: some point of it is that far; 0 outside the domain.
  std::vector<double> triangle_lower;
};

/// The triangles whose distance from a surface is bounded. Those whose last two points are equal are lines.
class TriangleList {
 public:
  /// All of these triangles. The points and triangles must outlive this object.
  TriangleList(std::span<const Vec3> points, std::span<const ClosestPointTree::Triangle> triangles)
      : points_(points), triangles_(triangles) {}
  /// The triangles of a tree, in the order of their indices. The tree must outlive this object.
  explicit TriangleList(const ClosestPointTree& tree)
      : points_(tree.points()), triangles_(tree.triangles()), indices_(tree.indices()), tree_(&tree) {}

  [[nodiscard]] std::size_t size() const { return indices_ ? indices_->size() : triangles_.size(); }
  /// The tree whose triangles these are; null if there is none.
  [[nodiscard]] const ClosestPointTree* tree() const { return tree_; }
  /// The place in the list of a triangle of the tree.
  [[nodiscard]] std::uint32_t place(std::uint32_t index) const {
    if (indices_->size() == triangles_.size()) return index;
    return static_cast<std::uint32_t>(std::ranges::lower_bound(*indices_, index) - indices_->begin());
  }
  /// The index of the triangle at a place of the list.
  [[nodiscard]] std::uint32_t index(std::size_t place) const {
    return indices_ ? (*indices_)[place] : static_cast<std::uint32_t>(place);
  }
  [[nodiscard]] const ClosestPointTree::Triangle& operator[](std::size_t place) const {
    return triangles_[index(place)];
  }
  [[nodiscard]] const Vec3& point(std::uint32_t p) const { return points_[p]; }
  [[nodiscard]] std::array<Vec3, 3> corners(std::size_t place) const {
    const ClosestPointTree::Triangle& t = (*this)[place];
    return {points_[t[0]], points_[t[1]], points_[t[2]]};
  }

 private:
  std::span<const Vec3> points_;
  std::span<const ClosestPointTree::Triangle> triangles_;
  std::optional<std::vector<std::uint32_t>> indices_;
  const ClosestPointTree* tree_ = nullptr;
};

/// Bounds the distance of triangles from the surface in the tree. Groups of a tree's triangles are bounded as
/// wholes where the middle of the box round them is close enough. The distance to one triangle is convex, so
/// that over a piece it is greatest at a corner; pieces are divided until the least such bound, over
/// triangles close to the piece, is good enough. Bounds are infinite where the tree is empty. The result does
/// not depend on the number of threads. Throws Cancelled where `progress` says so.
DistanceBound directed_distance_bound(const TriangleList& triangles, const ClosestPointTree& to,
                                      const HausdorffOptions& options = {},
                                      const Progress& progress = SilentProgress::instance());

/// Begins directed_distance_bound(): bounds groups of triangles, and returns the places of the triangles that
/// are left. These need bounds, from elsewhere or by finish_distance_bound().
std::vector<std::uint32_t> begin_distance_bound(const TriangleList& triangles, const ClosestPointTree& to,
                                                const HausdorffOptions& options, DistanceBound& bound,
                                                const Progress& progress = SilentProgress::instance());

/// Begins to bound the distances of a tree's triangles again after some of the surface, or of the triangles,
/// has changed. Triangles keep bounds of at most the accepted distance if they are farther than that from
/// `changes`, the triangles that the surface has lost and gained; all others need new bounds, and their
/// places are returned. `bound`: each of the triangles must have been bounded (HausdorffOptions::each) in the
/// same domain; infinitely for new ones.
std::vector<std::uint32_t> begin_distance_update(const TriangleList& triangles,
                                                 const ClosestPointTree& changes, const ClosestPointTree& to,
                                                 const HausdorffOptions& options, DistanceBound& bound,
                                                 const Progress& progress = SilentProgress::instance());

/// Bounds the triangles at these places, which are left.
void finish_distance_bound(const TriangleList& triangles, const std::vector<std::uint32_t>& places,
                           const ClosestPointTree& to, const HausdorffOptions& options, DistanceBound& bound,
                           const Progress& progress = SilentProgress::instance());

/// Tells whether a triangle of a surface serves the triangle at a place of a list.
using ServesTriangle = std::function<bool(std::uint32_t place, std::uint32_t found)>;

/// Bounds the distances of the triangles at these places as each of them would be from any part of a surface
/// that has the triangles that serve it: infinitely if others are found to be closest to some of its points.
/// Bounds of triangles follow the order of the places.
DistanceBound bound_served_triangles(const TriangleList& triangles, const std::vector<std::uint32_t>& places,
                                     const ClosestPointTree& to, const ServesTriangle& serves,
                                     const HausdorffOptions& options,
                                     const Progress& progress = SilentProgress::instance());

/// Makes a bound of the same triangles, surface and domain as tight as the options ask for. Only triangles
/// whose bounds are too loose are examined, those with the greatest bounds first.
void tighten_distance_bound(const TriangleList& triangles, const ClosestPointTree& to,
                            const HausdorffOptions& options, DistanceBound& bound,
                            const Progress& progress = SilentProgress::instance());

}  // namespace adamas::inline core
