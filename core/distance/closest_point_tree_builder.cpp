#include "core/distance/closest_point_tree_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/assert.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"

namespace adamas::inline core {

namespace {

constexpr std::size_t kDeferBelow = 16384;
constexpr int kBins = 16;
constexpr int kMedianDepth = 60;  // beyond, halves: bounds the depth on the most lopsided input
constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

float below(double x) {
  const float f = static_cast<float>(std::clamp(x, -3e38, 3e38));
  return std::nextafter(f, -kFloatInfinity);
}

float above(double x) { return -below(-x); }

/// Twice the centre of a box, which orders boxes as the centre does.
float middle(const std::array<float, 3>& lower, const std::array<float, 3>& upper, int axis) {
  const auto k = static_cast<std::size_t>(axis);
  return lower[k] + upper[k];
}

}  // namespace

ClosestPointTreeBuilder::FloatBox ClosestPointTreeBuilder::FloatBox::empty() {
  return {{kFloatInfinity, kFloatInfinity, kFloatInfinity},
          {-kFloatInfinity, -kFloatInfinity, -kFloatInfinity}};
}

void ClosestPointTreeBuilder::FloatBox::extend(const FloatBox& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    lower[k] = std::min(lower[k], b.lower[k]);
    upper[k] = std::max(upper[k], b.upper[k]);
  }
}

float ClosestPointTreeBuilder::FloatBox::half_area() const {
  const float x = upper[0] - lower[0], y = upper[1] - lower[1], z = upper[2] - lower[2];
  return x * y + y * z + z * x;
}

ClosestPointTreeBuilder::ClosestPointTreeBuilder(ClosestPointTree& tree, std::span<const Vec3> points,
                                                 std::span<const ClosestPointTree::Triangle> triangles)
    : tree_(tree), points_(points), triangles_(triangles), items_(triangles.size()) {}

ClosestPointTreeBuilder::FloatBox ClosestPointTreeBuilder::box_of(const ClosestPointTree::Triangle& t) const {
  const Vec3 low = tree_.bounds_.min, high = tree_.bounds_.max;
  FloatBox box = FloatBox::empty();
  for (int axis = 0; axis < 3; ++axis) {
    // Covers the rounding errors of distances, which are computed from the untransformed coordinates.
    const double pad = 1e-15 * tree_.scale_ * std::max(std::abs(low[axis]), std::abs(high[axis]));
    const auto k = static_cast<std::size_t>(axis);
    for (const std::uint32_t v : t) {
      const double x = tree_.to_tree(points_[v])[axis];
      box.lower[k] = std::min(box.lower[k], below(x - pad));
      box.upper[k] = std::max(box.upper[k], above(x + pad));
    }
  }
  return box;
}

ClosestPointTreeBuilder::FloatBox ClosestPointTreeBuilder::box_of_items(std::size_t begin,
                                                                        std::size_t end) const {
  FloatBox box = FloatBox::empty();
  for (std::size_t i = begin; i < end; ++i) box.extend(items_[i].box);
  return box;
}

void ClosestPointTreeBuilder::build() {
  parallel_for(items_.size(), 8192, [this](std::size_t i) {
    items_[i] = {box_of(triangles_[i]), static_cast<std::uint32_t>(i)};
  });
  tree_.nodes_.clear();
  if (!items_.empty()) {
    std::vector<Deferred> deferred;
    build_node({0, items_.size(), box_of_items(0, items_.size()), 0}, tree_.nodes_, &deferred);
    build_deferred(deferred);
  }
  tree_.index_.resize(items_.size());
  for (std::size_t i = 0; i < items_.size(); ++i) tree_.index_[i] = items_[i].triangle;
}

void ClosestPointTreeBuilder::build_deferred(const std::vector<Deferred>& deferred) {
  std::vector<Nodes> parts(deferred.size());
  parallel_for(deferred.size(), 1, [&](std::size_t i) { build_node(deferred[i].range, parts[i], nullptr); });
  for (std::size_t i = 0; i < deferred.size(); ++i) {
    const auto offset = static_cast<std::uint32_t>(tree_.nodes_.size());
    for (ClosestPointTree::Node node : parts[i]) {
      for (int k = 0; k < ClosestPointTree::kWidth; ++k) {
        if (node.count[k] == 0) node.first[k] += offset;
      }
      tree_.nodes_.push_back(node);
    }
    tree_.nodes_[deferred[i].parent].first[deferred[i].slot] = offset;
  }
}

std::uint32_t ClosestPointTreeBuilder::build_node(const Range& range, Nodes& nodes,
                                                  std::vector<Deferred>* deferred) {
  constexpr std::uint32_t kLeafSize = ClosestPointTree::kLeafSize;
  if (range.count() >= kDeferBelow) LoopProgress::check();
  std::array<Range, ClosestPointTree::kWidth> children{range};
  std::size_t count = 1;
  while (count < children.size()) {
    std::size_t largest = count;
    for (std::size_t i = 0; i < count; ++i) {
      if (children[i].count() <= kLeafSize) continue;
      if (largest == count || children[i].box.half_area() > children[largest].box.half_area()) largest = i;
    }
    if (largest == count) break;
    const auto halves = split(children[largest]);
    children[largest] = halves[0];
    children[count++] = halves[1];
  }

  const auto id = static_cast<std::uint32_t>(nodes.size());
  nodes.emplace_back();
  for (std::size_t i = 0; i < children.size(); ++i) {
    const FloatBox box = i < count ? children[i].box : FloatBox::empty();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      nodes[id].lower[axis][i] = box.lower[axis];
      nodes[id].upper[axis][i] = box.upper[axis];
    }
    nodes[id].first[i] = 0;
    nodes[id].count[i] = ClosestPointTree::kEmptySlot;
    if (i >= count) continue;
    if (children[i].count() <= kLeafSize) {
      nodes[id].first[i] = static_cast<std::uint32_t>(children[i].begin);
      nodes[id].count[i] = static_cast<std::uint32_t>(children[i].count());
      continue;
    }
    nodes[id].count[i] = 0;
    if (deferred != nullptr && children[i].count() < kDeferBelow) {
      deferred->push_back({children[i], id, static_cast<int>(i)});
    } else {
      const std::uint32_t child = build_node(children[i], nodes, deferred);
      nodes[id].first[i] = child;
    }
  }
  return id;
}

std::array<ClosestPointTreeBuilder::Range, 2> ClosestPointTreeBuilder::split(const Range& range) {
  std::array<float, 3> from{kFloatInfinity, kFloatInfinity, kFloatInfinity};
  std::array<float, 3> to{-kFloatInfinity, -kFloatInfinity, -kFloatInfinity};
  for (std::size_t i = range.begin; i < range.end; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      const float m = middle(items_[i].box.lower, items_[i].box.upper, axis);
      from[k] = std::min(from[k], m);
      to[k] = std::max(to[k], m);
    }
  }
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    const auto a = static_cast<std::size_t>(axis), b = static_cast<std::size_t>(k);
    if (to[b] - from[b] > to[a] - from[a]) axis = k;
  }
  const auto widest = static_cast<std::size_t>(axis);
  std::size_t cut = range.begin;
  if (to[widest] > from[widest] && range.depth < kMedianDepth) {
    cut = partition(range, axis, from[widest], to[widest]);
  }
  if (cut == range.begin || cut == range.end) {
    cut = range.begin + range.count() / 2;
    const auto first = items_.begin();
    std::nth_element(first + static_cast<std::ptrdiff_t>(range.begin),
                     first + static_cast<std::ptrdiff_t>(cut), first + static_cast<std::ptrdiff_t>(range.end),
                     [axis](const Item& a, const Item& b) {
                       const float x = middle(a.box.lower, a.box.upper, axis);
                       const float y = middle(b.box.lower, b.box.upper, axis);
                       return x != y ? x < y : a.triangle < b.triangle;
                     });
  }
  return {Range{range.begin, cut, box_of_items(range.begin, cut), range.depth + 1},
          Range{cut, range.end, box_of_items(cut, range.end), range.depth + 1}};
}

std::size_t ClosestPointTreeBuilder::partition(const Range& range, int axis, float from, float to) {
  const float scale = static_cast<float>(kBins) / (to - from);
  const auto bin_of = [&](const Item& item) {
    const float x = (middle(item.box.lower, item.box.upper, axis) - from) * scale;
    return x >= static_cast<float>(kBins - 1) ? kBins - 1 : (x > 0 ? static_cast<int>(x) : 0);
  };
  std::array<FloatBox, kBins> boxes;
  boxes.fill(FloatBox::empty());
  std::array<std::size_t, kBins> counts{};
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const auto bin = static_cast<std::size_t>(bin_of(items_[i]));
    boxes[bin].extend(items_[i].box);
    ++counts[bin];
  }
  // cost[b]: of all items in bins up to b on one side and the rest on the other.
  std::array<float, kBins> cost{};
  FloatBox box = FloatBox::empty();
  std::size_t sum = 0;
  for (std::size_t b = 0; b + 1 < kBins; ++b) {
    box.extend(boxes[b]);
    sum += counts[b];
    cost[b] = sum == 0 ? kFloatInfinity : box.half_area() * static_cast<float>(sum);
  }
  box = FloatBox::empty();
  sum = 0;
  int best = 0;
  for (std::size_t b = kBins - 1; b > 0; --b) {
    box.extend(boxes[b]);
    sum += counts[b];
    cost[b - 1] += sum == 0 ? kFloatInfinity : box.half_area() * static_cast<float>(sum);
    if (cost[b - 1] <= cost[static_cast<std::size_t>(best)]) best = static_cast<int>(b - 1);
  }
  const auto first = items_.begin() + static_cast<std::ptrdiff_t>(range.begin);
  const auto last = items_.begin() + static_cast<std::ptrdiff_t>(range.end);
  return static_cast<std::size_t>(
      std::partition(first, last, [&](const Item& item) { return bin_of(item) <= best; }) - items_.begin());
}

}  // namespace adamas::inline core
