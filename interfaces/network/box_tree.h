#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/vec3.h"

namespace adamas {

/// A binary tree of boxes, for those that are near a point.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::span<const Box3> boxes);

  /// Indices of the boxes within `radius` of p (at most), ascending; replaces `out`.
  void near(const Vec3& p, double radius, std::vector<std::uint32_t>& out) const;

 private:
  struct Node {
    Box3 box;
    std::uint32_t first,
        count;  ///< leaf: boxes order_[first, first + count); else children first and first + 1
  };
  void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end, std::span<const Box3> boxes);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
  std::vector<Box3> boxes_;  ///< in the order of order_
};

/// Squared distance from a point to a box; zero inside.
double squared_distance(const Box3& box, const Vec3& p);

}  // namespace adamas
