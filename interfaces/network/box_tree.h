#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "adamas/geometry.h"

namespace adamas::interfaces {

/// A binary tree of boxes that finds the boxes near a point, those that touch a box, and those that touch
/// each other. The order of the tree is that of the original boxes; it stays efficient as long as the boxes
/// do not move far.
class BoxTree {
 public:
  BoxTree() = default;
  /// Builds a tree of fewer than 2^31 boxes. Empty boxes are near nothing and touch nothing. This takes time
  /// O(n log n).
  explicit BoxTree(std::span<const Box3> boxes);

  /// Replaces the box with this index.
  void set(std::uint32_t index, const Box3& box);

  /// Sets `out` to the indices, ascending, of the boxes whose distance from p is at most `radius`.
  void near(const Vec3& p, double radius, std::vector<std::uint32_t>& out) const;
  /// Calls visit(index) for the boxes that touch `box`, in the order of the tree, until it returns false.
  template <class Visit>
  void for_each_touching(const Box3& box, Visit&& visit) const;
  /// Calls visit(i, j) once for every two boxes that touch each other, with i < j, from several threads at
  /// once and in any order.
  void for_each_touching_pair(const std::function<void(std::uint32_t, std::uint32_t)>& visit) const;

 private:
  static constexpr std::uint32_t kLeafSize = 4;

  /// The centre of a box, by which the tree is ordered when it is built.
  struct Center {
    Vec3 twice;  ///< the centre, times two
    std::uint32_t index;
  };
  /// A pair of nodes of the same level, or one node twice.
  struct NodePair {
    std::uint32_t a, b;
  };

  static void halve(std::span<Center> centers, std::size_t middle);
  [[nodiscard]] std::uint32_t first_leaf() const { return static_cast<std::uint32_t>(nodes_.size() / 2); }
  [[nodiscard]] bool is_leaf(std::uint32_t node) const { return node >= first_leaf(); }
  /// The boxes of a leaf have the places [begin, end).
  struct Places {
    std::uint32_t begin, end;
  };
  [[nodiscard]] Places places(std::uint32_t leaf) const;
  [[nodiscard]] Box3 box_of_leaf(std::uint32_t leaf) const;
  void append_children(const NodePair& pair, std::vector<NodePair>& out) const;
  void visit_leaves(const NodePair& pair,
                    const std::function<void(std::uint32_t, std::uint32_t)>& visit) const;

  std::vector<Box3> nodes_;  ///< a complete binary tree: node i has the children 2i and 2i + 1, the root is 1
  std::vector<Box3> boxes_;  ///< indexed by place, leaf after leaf
  std::vector<std::uint32_t> index_;  ///< the index of the box at each place
  std::vector<std::uint32_t> place_;  ///< the place of the box with each index
};

/// Returns the squared distance from a point to a box; zero inside.
double squared_distance(const Box3& box, const Vec3& p);

template <class Visit>
void BoxTree::for_each_touching(const Box3& box, Visit&& visit) const {
  if (boxes_.empty()) return;
  std::uint32_t stack[64];
  std::size_t size = 0;
  stack[size++] = 1;
  while (size > 0) {
    const std::uint32_t node = stack[--size];
    if (!nodes_[node].touches(box)) continue;
    if (!is_leaf(node)) {
      stack[size++] = 2 * node + 1;
      stack[size++] = 2 * node;
      continue;
    }
    const Places leaf = places(node);
    for (std::uint32_t place = leaf.begin; place < leaf.end; ++place) {
      if (boxes_[place].touches(box) && !visit(index_[place])) return;
    }
  }
}

}  // namespace adamas::interfaces
