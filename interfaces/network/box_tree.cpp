#include "interfaces/network/box_tree.h"

#include <algorithm>
#include <numeric>

namespace adamas {

namespace {

constexpr std::uint32_t kLeafSize = 8;

}  // namespace

double squared_distance(const Box3& box, const Vec3& p) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double gap = std::max({box.min[axis] - p[axis], p[axis] - box.max[axis], 0.0});
    sum += gap * gap;
  }
  return sum;
}

BoxTree::BoxTree(std::span<const Box3> boxes) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  if (boxes.empty()) return;
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(boxes.size()), boxes);
  for (const std::uint32_t i : order_) boxes_.push_back(boxes[i]);
}

void BoxTree::build(std::uint32_t node, std::uint32_t begin, std::uint32_t end, std::span<const Box3> boxes) {
  Box3 box;
  Box3 centers;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Box3& b = boxes[order_[i]];
    box.extend(b.min);
    box.extend(b.max);
    centers.extend(b.center());
  }
  nodes_[node] = {box, begin, end - begin};
  if (end - begin <= kLeafSize) return;
  const Vec3 size = centers.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t i, std::uint32_t j) {
                     const double x = boxes[i].center()[axis], y = boxes[j].center()[axis];
                     return x != y ? x < y : i < j;
                   });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node] = {box, child, 0};
  nodes_.resize(nodes_.size() + 2);
  build(child, begin, middle, boxes);
  build(child + 1, middle, end, boxes);
}

void BoxTree::near(const Vec3& p, double radius, std::vector<std::uint32_t>& out) const {
  out.clear();
  if (nodes_.empty()) return;
  // The margin keeps boxes whose distance is the radius but for round-off.
  const double bound = radius * radius * (1 + 1e-12);
  std::uint32_t stack[64];
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    if (squared_distance(node.box, p) > bound) continue;
    if (node.count == 0) {
      stack[top++] = node.first;
      stack[top++] = node.first + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (squared_distance(boxes_[i], p) <= bound) out.push_back(order_[i]);
    }
  }
  std::sort(out.begin(), out.end());
}

}  // namespace adamas
