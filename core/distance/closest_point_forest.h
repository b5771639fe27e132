#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/distance/closest_point_tree.h"

namespace adamas::inline core {

/// Trees of groups of triangles, such as the interfaces of a network, of sets of these groups, and of all of
/// them. Each triangle is stored once, and each group is built once: a set has only the few nodes above large
/// parts of its groups. Triangles have the same numbers in all trees. Copies share all data.
class ClosestPointForest {
 public:
  using Triangle = ClosestPointTree::Triangle;

  ClosestPointForest() : ClosestPointForest({}, {}) {}
  /// Makes one group of all triangles.
  ClosestPointForest(std::vector<Vec3> points, std::vector<Triangle> triangles)
      : ClosestPointForest(std::move(points), std::move(triangles), 1, nullptr, {}) {}
  /// `group_of`: the group of a triangle, below `groups`. `sets`: lists of different groups.
  ClosestPointForest(std::vector<Vec3> points, std::vector<Triangle> triangles, std::size_t groups,
                     const std::function<std::uint32_t(std::uint32_t)>& group_of,
                     std::vector<std::vector<std::uint32_t>> sets);

  [[nodiscard]] std::span<const Vec3> points() const { return hierarchy_->points; }
  [[nodiscard]] std::span<const Triangle> triangles() const { return hierarchy_->triangles; }
  [[nodiscard]] std::array<Vec3, 3> corners(std::uint32_t triangle) const {
    return hierarchy_->corners(triangle);
  }
  [[nodiscard]] const ClosestPointTree& all() const { return trees_.back(); }
  [[nodiscard]] const ClosestPointTree& group(std::size_t i) const { return trees_[i]; }
  [[nodiscard]] const ClosestPointTree& set(std::size_t i) const { return trees_[groups_ + i]; }

 private:
  std::shared_ptr<const TriangleHierarchy> hierarchy_;
  std::size_t groups_;
  std::vector<ClosestPointTree> trees_;  ///< of groups, of sets and of all triangles
};

}  // namespace adamas::inline core
