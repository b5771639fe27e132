#include "interfaces/network/box_tree.h"

#include <algorithm>
#include <bit>

#include "core/base/parallel.h"

namespace adamas::interfaces {

namespace {

/// The least number of pairs of nodes that are processed in parallel, if there are as many.
constexpr std::size_t kTasks = 1024;
/// The number of boxes that one thread orders at a time.
constexpr std::size_t kBoxesPerTask = 8192;

bool is_empty(const Box3& box) { return !(box.min.x <= box.max.x); }

Box3 joined(Box3 a, const Box3& b) {
  if (is_empty(b)) return a;
  a.extend(b.min);
  a.extend(b.max);
  return a;
}

}  // namespace

double squared_distance(const Box3& box, const Vec3& p) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double gap = std::max({box.min[axis] - p[axis], p[axis] - box.max[axis], 0.0});
    sum += gap * gap;
  }
  return sum;
}

BoxTree::BoxTree(std::span<const Box3> boxes)
    : boxes_(boxes.size()), index_(boxes.size()), place_(boxes.size()) {
  if (boxes.empty()) return;
  std::vector<Center> centers(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    centers[i] = {is_empty(boxes[i]) ? Vec3{} : boxes[i].min + boxes[i].max, i};
  const std::size_t leaves = std::bit_ceil((boxes.size() + kLeafSize - 1) / kLeafSize);
  // The tree is built level by level: each node's boxes are divided among its children, which are full except
  // for the last ones.
  for (std::size_t size = leaves * kLeafSize; size > kLeafSize; size /= 2) {
    parallel_for(leaves * kLeafSize / size, std::max<std::size_t>(kBoxesPerTask / size, 1),
                 [&](std::size_t i) {
                   const std::size_t begin = i * size, middle = begin + size / 2,
                                     end = std::min(begin + size, centers.size());
                   if (middle < end) halve(std::span(centers).subspan(begin, end - begin), size / 2);
                 });
  }
  for (std::uint32_t place = 0; place < centers.size(); ++place) {
    index_[place] = centers[place].index;
    place_[index_[place]] = place;
    boxes_[place] = boxes[index_[place]];
  }
  nodes_.resize(2 * leaves);
  for (auto leaf = first_leaf(); leaf < nodes_.size(); ++leaf) nodes_[leaf] = box_of_leaf(leaf);
  for (std::size_t i = leaves; --i > 0;) nodes_[i] = joined(nodes_[2 * i], nodes_[2 * i + 1]);
}

/// Puts the `middle` first centres along the longest side of their bounding box before the others.
void BoxTree::halve(std::span<Center> centers, std::size_t middle) {
  Box3 bounds;
  for (const Center& c : centers) bounds.extend(c.twice);
  const Vec3 size = bounds.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::nth_element(centers.begin(), centers.begin() + static_cast<std::ptrdiff_t>(middle), centers.end(),
                   [axis](const Center& a, const Center& b) {
                     const double x = a.twice[axis], y = b.twice[axis];
                     return x != y ? x < y : a.index < b.index;
                   });
}

BoxTree::Places BoxTree::places(std::uint32_t leaf) const {
  const auto count = static_cast<std::uint32_t>(boxes_.size());
  const std::uint32_t begin = std::min((leaf - first_leaf()) * kLeafSize, count);
  return {begin, std::min(begin + kLeafSize, count)};
}

Box3 BoxTree::box_of_leaf(std::uint32_t leaf) const {
  const Places range = places(leaf);
  Box3 box;
  for (std::uint32_t place = range.begin; place < range.end; ++place) box = joined(box, boxes_[place]);
  return box;
}

void BoxTree::set(std::uint32_t index, const Box3& box) {
  const std::uint32_t place = place_[index];
  boxes_[place] = box;
  std::uint32_t node = first_leaf() + place / kLeafSize;
  nodes_[node] = box_of_leaf(node);
  while ((node /= 2) > 0) nodes_[node] = joined(nodes_[2 * node], nodes_[2 * node + 1]);
}

void BoxTree::near(const Vec3& p, double radius, std::vector<std::uint32_t>& out) const {
  out.clear();
  if (boxes_.empty()) return;
  // The margin keeps boxes whose distance equals the radius up to round-off.
  const double bound = radius * radius * (1 + 1e-12);
  std::uint32_t stack[64];
  std::size_t top = 0;
  stack[top++] = 1;
  while (top > 0) {
    const std::uint32_t node = stack[--top];
    if (!(squared_distance(nodes_[node], p) <= bound)) continue;
    if (!is_leaf(node)) {
      stack[top++] = 2 * node;
      stack[top++] = 2 * node + 1;
      continue;
    }
    const Places leaf = places(node);
    for (std::uint32_t place = leaf.begin; place < leaf.end; ++place) {
      if (squared_distance(boxes_[place], p) <= bound) out.push_back(index_[place]);
    }
  }
  std::sort(out.begin(), out.end());
}

/// Appends the pairs of children that touch each other.
void BoxTree::append_children(const NodePair& pair, std::vector<NodePair>& out) const {
  for (const std::uint32_t a : {2 * pair.a, 2 * pair.a + 1}) {
    for (const std::uint32_t b : {2 * pair.b, 2 * pair.b + 1}) {
      if (pair.a == pair.b && b < a) continue;
      if (nodes_[a].touches(nodes_[b])) out.push_back({a, b});
    }
  }
}

void BoxTree::visit_leaves(const NodePair& pair,
                           const std::function<void(std::uint32_t, std::uint32_t)>& visit) const {
  const Places first = places(pair.a), second = places(pair.b);
  for (std::uint32_t a = first.begin; a < first.end; ++a) {
    for (std::uint32_t b = pair.a == pair.b ? a + 1 : second.begin; b < second.end; ++b) {
      if (boxes_[a].touches(boxes_[b])) visit(std::min(index_[a], index_[b]), std::max(index_[a], index_[b]));
    }
  }
}

void BoxTree::for_each_touching_pair(const std::function<void(std::uint32_t, std::uint32_t)>& visit) const {
  if (boxes_.empty()) return;
  std::vector<NodePair> tasks{{1, 1}}, children;
  // All pairs in the list are of one level, so either all or none are leaves.
  while (!tasks.empty() && tasks.size() < kTasks && !is_leaf(tasks.front().a)) {
    children.clear();
    for (const NodePair& pair : tasks) append_children(pair, children);
    std::swap(tasks, children);
  }
  parallel_for(tasks.size(), 1, [&](std::size_t i) {
    std::vector<NodePair> stack{tasks[i]};
    while (!stack.empty()) {
      const NodePair pair = stack.back();
      stack.pop_back();
      if (is_leaf(pair.a)) {
        visit_leaves(pair, visit);
      } else {
        append_children(pair, stack);
      }
    }
  });
}

}  // namespace adamas::interfaces
