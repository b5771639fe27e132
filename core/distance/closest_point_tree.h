#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "adamas/geometry.h"
#include "core/distance/triangle_distance.h"
#include "core/distance/triangle_hierarchy.h"

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

/// Finds closest points, rays' hits and overlaps of triangles by boxes round them. Boxes are floats, rounded
/// outwards; triangles are tested in double. Results are those of testing every triangle in order, bit for
/// bit; among triangles at equal distance the one of the lowest index is found. Copies share all data.
class ClosestPointTree {
 public:
  using Triangle = TriangleHierarchy::Triangle;
  static constexpr std::uint32_t kNoTriangle = 0xffffffffu;

  ClosestPointTree() = default;
  /// Copies the triangles and their points. Points must be finite, indices within range and triangles fewer
  /// than 2^31; they may be degenerate.
  ClosestPointTree(std::span<const Vec3> points, std::span<const Triangle> triangles);

  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// The number of triangles.
  [[nodiscard]] std::size_t size() const { return count_; }
  /// The box round all triangles.
  [[nodiscard]] const Box3& bounds() const { return bounds_; }
  /// The corners of the triangle with this index.
  [[nodiscard]] std::array<Vec3, 3> triangle(std::uint32_t index) const { return hierarchy_->corners(index); }
  /// The indices of its triangles, ascending: not all of points() and triangles() if the tree is one of a
  /// ClosestPointForest.
  [[nodiscard]] std::vector<std::uint32_t> indices() const;
  [[nodiscard]] std::span<const Vec3> points() const;
  [[nodiscard]] std::span<const Triangle> triangles() const;
  /// The memory of this tree and of all that share their data with it.
  [[nodiscard]] std::size_t memory_bytes() const;

  /// The closest point with a distance of at most `max_distance`; empty if there is none or q is not finite.
  [[nodiscard]] std::optional<ClosestPoint> closest(
      const Vec3& q, double max_distance = std::numeric_limits<double>::infinity()) const;
  /// The same as closest(q), and sooner if a triangle of the tree that is given as a guess is close to q.
  [[nodiscard]] std::optional<ClosestPoint> closest_from(const Vec3& q, std::uint32_t guess) const;
  /// Whether a triangle is at most this far: as closest(), but it ends at the first triangle that is.
  [[nodiscard]] bool is_within(const Vec3& q, double max_distance) const;
  /// The hit with the least t in [0, max_t], not counting triangle `ignore`. It is watertight: no ray slips
  /// between two triangles that share an edge. Rays within the plane of a triangle do not meet it.
  [[nodiscard]] std::optional<RayHit> first_hit(const Vec3& origin, const Vec3& direction,
                                                double max_t = std::numeric_limits<double>::infinity(),
                                                std::uint32_t ignore = kNoTriangle) const;
  /// Whether a triangle touches the closed box.
  [[nodiscard]] bool any_overlap(const Box3& box) const;
  /// The triangles that touch the closed box, in ascending order; replaces `out`.
  void overlapping(const Box3& box, std::vector<std::uint32_t>& out) const;

  /// Some of the triangles, and a box round them.
  struct Group {
    Box3 box;
    TriangleHierarchy::Child child;
  };
  /// All triangles as one group. The tree must not be empty.
  [[nodiscard]] Group whole() const { return {bounds_, root_}; }
  /// Whether a group is not divided further; it has few triangles then.
  [[nodiscard]] static bool is_leaf(const Group& group) { return group.child.count > 0; }
  /// Appends the groups that a group consists of, which are smaller.
  void divide(const Group& group, std::vector<Group>& parts) const;
  /// Calls visit(index) for the triangles of a group, in no particular order.
  template <class Visit>
  void for_each_triangle(const Group& group, Visit&& visit) const;

  /// Checks the tree: throws Error that names the first broken law. Every triangle has to be in exactly one
  /// leaf and inside all boxes above it.
  void validate() const;

 private:
  friend class ClosestPointForest;
  using Child = TriangleHierarchy::Child;

  ClosestPointTree(std::shared_ptr<const TriangleHierarchy> hierarchy, Child root, std::size_t count,
                   const Box3& bounds)
      : hierarchy_(std::move(hierarchy)), root_(root), count_(count), bounds_(bounds) {}

  /// Calls visit(place, bound) for places of triangles in the order in which their boxes are near q. `bound`
  /// is the squared distance that still matters; visit may lower it and returns whether to go on.
  template <class Visit>
  void visit_near(const Vec3& q, double squared_distance, Visit&& visit) const;
  void improve(const Vec3& q, ClosestPoint& best) const;
  template <class Visit>
  bool visit_overlapping(const Box3& box, Visit&& visit) const;
  void validate(Child child, const Box3& within, std::vector<char>& seen) const;

  std::shared_ptr<const TriangleHierarchy> hierarchy_;
  Child root_ = TriangleHierarchy::kNoChild;
  std::size_t count_ = 0;
  Box3 bounds_;
};

template <class Visit>
void ClosestPointTree::for_each_triangle(const Group& group, Visit&& visit) const {
  const Child& child = group.child;
  if (child.count == TriangleHierarchy::kEmptySlot) return;
  for (std::uint32_t place = child.first; place < child.first + child.count; ++place)
    visit(hierarchy_->triangle_at(place));
  if (child.count > 0) return;
  for (std::size_t i = 0; i < TriangleHierarchy::kWidth; ++i)
    for_each_triangle({{}, hierarchy_->nodes[child.first].child(i)}, visit);
}

/// Whether a triangle and a closed box have a point in common (separating axes; touching counts).
bool overlaps(const std::array<Vec3, 3>& corners, const Box3& box);

}  // namespace adamas::inline core
