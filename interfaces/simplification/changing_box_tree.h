#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/vec3.h"

namespace adamas {

/// Boxes that change and vanish, for those that touch another one. The tree is that of the first boxes, and
/// serves well as long as they stay where they were, more or less.
class ChangingBoxTree {
 public:
  ChangingBoxTree() = default;
  explicit ChangingBoxTree(std::span<const Box3> boxes);

  /// An empty box is touched by none.
  void set(std::uint32_t item, const Box3& box);
  /// Calls visit(item) for boxes that touch this one, until it returns false.
  template <class Visit>
  void for_each_touching(const Box3& box, Visit&& visit) const;

 private:
  void order(std::span<const Box3> boxes, std::uint32_t leaf, std::uint32_t leaves);
  [[nodiscard]] std::uint32_t first_leaf() const { return static_cast<std::uint32_t>(nodes_.size() / 2); }

  std::vector<Box3> nodes_;  ///< a complete binary tree: node i has the children 2i and 2i + 1, the root is 1
  std::vector<std::uint32_t> items_;  ///< by leaf
  std::vector<std::uint32_t> leaf_;   ///< by item
};

template <class Visit>
void ChangingBoxTree::for_each_touching(const Box3& box, Visit&& visit) const {
  if (items_.empty() || !nodes_[1].touches(box)) return;
  std::uint32_t stack[72];
  std::size_t size = 0;
  stack[size++] = 1;
  while (size > 0) {
    const std::uint32_t node = stack[--size];
    if (node >= first_leaf()) {
      if (!visit(items_[node - first_leaf()])) return;
      continue;
    }
    for (const std::uint32_t child : {2 * node + 1, 2 * node}) {
      if (nodes_[child].touches(box)) stack[size++] = child;
    }
  }
}

}  // namespace adamas
