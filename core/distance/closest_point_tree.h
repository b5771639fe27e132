#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/large_pages.h"
#include "core/distance/triangle_distance.h"

namespace adamas::inline core {

/// The closest point of a set of triangles.
struct ClosestPoint {
  Vec3 point;
  double squared_distance = std::numeric_limits<double>::infinity();
  std::uint32_t triangle = 0xffffffffu;
  TriangleFeature feature = TriangleFeature::kFace;
};

/// The point where a ray meets a triangle, `origin + t * direction`.
struct RayHit {
  double t = std::numeric_limits<double>::infinity();
  std::uint32_t triangle = 0xffffffffu;
  /// Weights of the three corners at the hit; one near zero means a hit close to an edge.
  std::array<double, 3> weights{};
};

/// A bounding-volume hierarchy over triangles, for closest points, rays and boxes. Nodes have eight children
/// whose boxes are floats, rounded outwards; triangles are kept and tested in double. Results are those of
/// testing every triangle in order, bit for bit; among triangles at equal distance the one of the lowest
/// index is found.
class ClosestPointTree {
 public:
  using Triangle = std::array<std::uint32_t, 3>;
  static constexpr std::uint32_t kNoTriangle = 0xffffffffu;

  ClosestPointTree() = default;
  /// Copies the corners. Points must be finite, indices within range and triangles fewer than 2^31; they may
  /// be degenerate.
  ClosestPointTree(std::span<const Vec3> points, std::span<const Triangle> triangles);

  [[nodiscard]] bool empty() const { return corners_.empty(); }
  /// The box round all triangles.
  [[nodiscard]] const Box3& bounds() const { return bounds_; }
  /// The corners of the triangle with this index.
  [[nodiscard]] const std::array<Vec3, 3>& triangle(std::uint32_t index) const {
    return corners_[place_[index]];
  }
  [[nodiscard]] std::size_t memory_bytes() const;

  /// The closest point with a distance of at most `max_distance`; empty if there is none or q is not finite.
  [[nodiscard]] std::optional<ClosestPoint> closest(
      const Vec3& q, double max_distance = std::numeric_limits<double>::infinity()) const;
  /// The hit with the least t in [0, max_t], not counting triangle `ignore`. It is watertight: no ray slips
  /// between two triangles that share an edge. Rays within the plane of a triangle do not meet it.
  [[nodiscard]] std::optional<RayHit> first_hit(const Vec3& origin, const Vec3& direction,
                                                double max_t = std::numeric_limits<double>::infinity(),
                                                std::uint32_t ignore = kNoTriangle) const;
  /// Whether a triangle touches the closed box.
  [[nodiscard]] bool any_overlap(const Box3& box) const;
  /// The triangles that touch the closed box, in ascending order; replaces `out`.
  void overlapping(const Box3& box, std::vector<std::uint32_t>& out) const;

  /// Checks the tree: throws Error that names the first broken law. Every triangle has to be in exactly one
  /// leaf and inside all boxes above it.
  void validate() const;

 private:
  friend class ClosestPointTreeBuilder;

  static constexpr int kWidth = 8;
  static constexpr std::uint32_t kLeafSize = 4;
  static constexpr std::size_t kStackSize = 1024;
  static constexpr std::uint32_t kSliver = 0x80000000u;
  static constexpr std::uint32_t kEmptySlot = 0xffffffffu;

  /// If `count[i]` is 0, child i is the node `first[i]`; otherwise it is the triangles at places [first[i],
  /// first[i] + count[i]).
  struct alignas(64) Node {
    float lower[3][kWidth];
    float upper[3][kWidth];
    std::uint32_t first[kWidth];
    std::uint32_t count[kWidth];
  };

  template <class Visit>
  bool visit_overlapping(const Box3& box, Visit&& visit) const;
  void validate_node(std::uint32_t node, const Box3& within, std::vector<char>& seen) const;
  [[nodiscard]] std::uint32_t index(std::size_t place) const { return index_[place] & ~kSliver; }
  [[nodiscard]] Vec3 to_tree(const Vec3& p) const { return scale_ * (p - center_); }

  using Nodes = std::vector<Node, LargePageAllocator<Node>>;
  using Corners = std::array<Vec3, 3>;
  Nodes nodes_;
  std::vector<Corners, LargePageAllocator<Corners>> corners_;  ///< in leaf order
  std::vector<std::uint32_t> index_;  ///< the index of the triangle at each place, with its flag kSliver
  std::vector<std::uint32_t> place_;  ///< the place of the triangle of each index
  Box3 bounds_;
  Vec3 center_;
  double scale_ = 1;  ///< a power of two: the tree has the points scale * (p - center)
};

/// Whether a triangle and a closed box have a point in common (separating axes; touching counts).
bool overlaps(const std::array<Vec3, 3>& corners, const Box3& box);

}  // namespace adamas::inline core
