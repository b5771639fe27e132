#include "interfaces/simplification/changing_box_tree.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace adamas {

namespace {

Box3 joined(Box3 a, const Box3& b) {
  if (b.min.x > b.max.x) return a;
  a.extend(b.min);
  a.extend(b.max);
  return a;
}

}  // namespace

ChangingBoxTree::ChangingBoxTree(std::span<const Box3> boxes) : items_(boxes.size()), leaf_(boxes.size()) {
  std::iota(items_.begin(), items_.end(), 0u);
  const std::size_t leaves = std::bit_ceil(std::max<std::size_t>(boxes.size(), 1));
  nodes_.resize(2 * leaves);
  order(boxes, 0, static_cast<std::uint32_t>(leaves));
  for (std::uint32_t leaf = 0; leaf < items_.size(); ++leaf) {
    leaf_[items_[leaf]] = leaf;
    nodes_[first_leaf() + leaf] = boxes[items_[leaf]];
  }
  for (std::size_t i = leaves; --i > 0;) nodes_[i] = joined(nodes_[2 * i], nodes_[2 * i + 1]);
}

/// Halves the items of a range of leaves along the longest side of the box of their centres.
void ChangingBoxTree::order(std::span<const Box3> boxes, std::uint32_t leaf, std::uint32_t leaves) {
  if (leaves < 2 || leaf + 1 >= items_.size()) return;
  const auto begin = items_.begin() + leaf;
  const auto end = items_.begin() + std::min<std::ptrdiff_t>(leaf + leaves, std::ssize(items_));
  const auto middle = begin + std::min<std::ptrdiff_t>(leaves / 2, end - begin);
  Box3 centers;
  for (auto i = begin; i != end; ++i) centers.extend(boxes[*i].center());
  const Vec3 size = centers.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::nth_element(begin, middle, end, [&](std::uint32_t i, std::uint32_t j) {
    const double x = boxes[i].center()[axis], y = boxes[j].center()[axis];
    return x < y || (x == y && i < j);
  });
  order(boxes, leaf, leaves / 2);
  order(boxes, leaf + leaves / 2, leaves / 2);
}

void ChangingBoxTree::set(std::uint32_t item, const Box3& box) {
  std::uint32_t node = first_leaf() + leaf_[item];
  nodes_[node] = box;
  while ((node /= 2) > 0) nodes_[node] = joined(nodes_[2 * node], nodes_[2 * node + 1]);
}

}  // namespace adamas
