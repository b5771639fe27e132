#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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
  double lower = 0;  ///< the distance at `worst`
  Vec3 worst;
  std::vector<double> triangle_upper;  ///< per triangle: no point of it is farther; 0 outside the domain
  /// Per triangle, if each was bounded: some point of it is that far; 0 outside the domain.
  std::vector<double> triangle_lower;
};

/// Bounds the distance of the triangles from the surface in the tree. The distance to one triangle is convex,
/// so that over a piece it is greatest at a corner; pieces are divided until the least such bound, over
/// triangles close to the piece, is good enough. Triangles whose last two points are equal are lines. The
/// bound is infinite where the tree is empty. The result does not depend on the number of threads. Throws
/// Cancelled where `progress` says so.
DistanceBound directed_distance_bound(std::span<const Vec3> points,
                                      std::span<const ClosestPointTree::Triangle> triangles,
                                      const ClosestPointTree& to, const HausdorffOptions& options = {},
                                      const Progress& progress = SilentProgress::instance());

/// Bounds the distances of these triangles again, after the surface near them has changed; the others keep
/// theirs. `bound`: each of its triangles must have been bounded (HausdorffOptions::each) in the same domain.
void update_distance_bound(std::span<const Vec3> points,
                           std::span<const ClosestPointTree::Triangle> triangles,
                           const std::vector<std::uint32_t>& changed, const ClosestPointTree& to,
                           HausdorffOptions options, DistanceBound& bound,
                           const Progress& progress = SilentProgress::instance());

/// Makes a bound of the same triangles, surface and domain as tight as the options ask for. Only triangles
/// whose bounds are too loose are examined, those with the greatest bounds first.
void tighten_distance_bound(std::span<const Vec3> points,
                            std::span<const ClosestPointTree::Triangle> triangles, const ClosestPointTree& to,
                            const HausdorffOptions& options, DistanceBound& bound,
                            const Progress& progress = SilentProgress::instance());

}  // namespace adamas::inline core
