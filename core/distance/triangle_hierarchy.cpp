#include "core/distance/triangle_hierarchy.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "core/base/assert.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/release_memory.h"
#include "core/base/simd.h"
#include "core/distance/triangle_distance.h"

namespace adamas::inline core {

namespace {

using Child = TriangleHierarchy::Child;
using Nodes = decltype(TriangleHierarchy::nodes);
using Lanes = Simd<float, 16>;

/// Smaller ranges are built in parallel and joined in order.
constexpr std::size_t kDeferBelow = 16384;
constexpr std::size_t kBins = 16;
/// Groups are joined by parts of at most so many triangles.
constexpr std::uint32_t kJoinedSize = 512;
/// Deeper ranges are halved, which bounds the depth on the most lopsided input.
constexpr int kMedianDepth = 32;
constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

/// A float less than x, by a few units in the last place.
float below(double x) {
  const float f = static_cast<float>(std::clamp(x, -3e38, 3e38));
  return f - (1.2e-7f * std::abs(f) + 1e-37f);
}

/// A float greater than x, by a few units in the last place.
float above(double x) { return -below(-x); }

/// What is ordered: a box with a number. Both halves are read as vectors.
struct alignas(16) Item {
  float lower[3];
  std::uint32_t number;
  float upper[3];
  std::uint32_t unused;
  /// Twice the centre, which orders boxes as the centre does.
  [[nodiscard]] float middle(std::size_t axis) const { return lower[axis] + upper[axis]; }
};
static_assert(sizeof(Item) == 32);

/// A box whose corners are vectors; their fourth numbers mean nothing.
struct Bounds {
  Lanes::Numbers lower = Lanes::Numbers{} + kFloatInfinity, upper = Lanes::Numbers{} - kFloatInfinity;

  static Bounds of(const Item& item) {
    using Words = Simd<std::uint32_t, 16>::Numbers;
    constexpr Words kThree{~0u, ~0u, ~0u, 0u};
    Words low, high;
    std::memcpy(&low, &item, sizeof low);
    std::memcpy(&high, reinterpret_cast<const char*>(&item) + sizeof low, sizeof high);
    low &= kThree, high &= kThree;
    Bounds bounds;
    std::memcpy(&bounds.lower, &low, sizeof low);
    std::memcpy(&bounds.upper, &high, sizeof high);
    return bounds;
  }
  void extend(const Bounds& b) {
    lower = Lanes::lesser(lower, b.lower);
    upper = Lanes::greater(upper, b.upper);
  }
  void extend(Lanes::Numbers point) {
    lower = Lanes::lesser(lower, point);
    upper = Lanes::greater(upper, point);
  }
  [[nodiscard]] float half_area() const {
    const Lanes::Numbers size = upper - lower;
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
};

/// The box round items and that round their middles.
struct ItemBounds {
  Bounds box, middles;
  void add(const Item& item) {
    const Bounds b = Bounds::of(item);
    box.extend(b);
    middles.extend(b.lower + b.upper);
  }
  void extend(const ItemBounds& b) {
    box.extend(b.box);
    middles.extend(b.middles);
  }
};

/// Builds nodes over items from the top: large ranges are cut where the areas of the two boxes, times the
/// numbers of items, have the least sum; small ones so that nodes and leaves are full.
class NodeBuilder {
 public:
  struct Range {
    std::size_t begin, end;
    ItemBounds bounds;
    int depth = 0;
    [[nodiscard]] std::size_t count() const { return end - begin; }
  };
  /// A range whose nodes are built later; its root belongs in child `slot` of node `parent`.
  struct Deferred {
    Range range;
    std::uint32_t parent;
    std::size_t slot;
  };

  NodeBuilder(std::span<Item> items, std::size_t leaf_size)
      : items_(items), leaf_size_(leaf_size), node_size_(leaf_size * TriangleHierarchy::kWidth) {}

  [[nodiscard]] Range range(std::size_t begin, std::size_t end) const {
    Range range{begin, end, {}};
    for (std::size_t i = begin; i < end; ++i) range.bounds.add(items_[i]);
    return range;
  }
  /// Appends the nodes of a range and returns their root; leaves have the places of items. `deferred`: gets
  /// small ranges that are left for later; null if there are none.
  Child build(const Range& range, Nodes& nodes, std::vector<Deferred>* deferred);

 private:
  [[nodiscard]] std::size_t divide(const Range& range,
                                   std::array<Range, TriangleHierarchy::kWidth>& children);
  [[nodiscard]] std::array<Range, 2> split(const Range& range);
  [[nodiscard]] std::array<Range, 2> cut_by_area(const Range& range, std::size_t axis);
  [[nodiscard]] std::array<Range, 2> halve(const Range& range, std::size_t axis);

  std::span<Item> items_;
  std::size_t leaf_size_, node_size_;
};

/// Divides a range into the children of its node; returns their number.
std::size_t NodeBuilder::divide(const Range& range, std::array<Range, TriangleHierarchy::kWidth>& children) {
  // A child that fills a node of its own is not divided here.
  const std::size_t whole = range.count() > node_size_ ? node_size_ : leaf_size_;
  children[0] = range;
  std::size_t count = 1;
  while (count < children.size()) {
    std::size_t largest = count;
    for (std::size_t i = 0; i < count; ++i) {
      if (children[i].count() <= whole) continue;
      if (largest == count || children[i].bounds.box.half_area() > children[largest].bounds.box.half_area())
        largest = i;
    }
    if (largest == count) break;
    const auto halves = split(children[largest]);
    children[largest] = halves[0];
    children[count++] = halves[1];
  }
  return count;
}

Child NodeBuilder::build(const Range& range, Nodes& nodes, std::vector<Deferred>* deferred) {
  if (range.count() == 0) return TriangleHierarchy::kNoChild;
  if (range.count() <= leaf_size_)
    return {static_cast<std::uint32_t>(range.begin), static_cast<std::uint32_t>(range.count())};
  if (range.count() >= kDeferBelow) LoopProgress::check();
  std::array<Range, TriangleHierarchy::kWidth> children;
  const std::size_t count = divide(range, children);
  const auto id = static_cast<std::uint32_t>(nodes.size());
  nodes.emplace_back();
  for (std::size_t i = 0; i < children.size(); ++i) {
    const Bounds box = i < count ? children[i].bounds.box : Bounds{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      nodes[id].lower[axis][i] = box.lower[axis];
      nodes[id].upper[axis][i] = box.upper[axis];
    }
    Child child = TriangleHierarchy::kNoChild;
    if (i < count) {
      const bool later =
          deferred != nullptr && children[i].count() > leaf_size_ && children[i].count() < kDeferBelow;
      if (later) deferred->push_back({children[i], id, i});
      if (!later) child = build(children[i], nodes, deferred);
    }
    nodes[id].first[i] = child.first;
    nodes[id].count[i] = child.count;
  }
  return {id, 0};
}

/// Orders the items of a range and divides it in two parts, none of them empty.
std::array<NodeBuilder::Range, 2> NodeBuilder::split(const Range& range) {
  const Lanes::Numbers size = range.bounds.middles.upper - range.bounds.middles.lower;
  const std::size_t axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : (size[1] >= size[2] ? 1 : 2);
  const bool is_large = range.count() > TriangleHierarchy::kWidth * node_size_;
  if (is_large && range.depth < kMedianDepth && size[axis] > 0) {
    const auto parts = cut_by_area(range, axis);
    if (parts[0].count() > 0 && parts[1].count() > 0) return parts;
  }
  return halve(range, axis);
}

std::array<NodeBuilder::Range, 2> NodeBuilder::cut_by_area(const Range& range, std::size_t axis) {
  const float from = range.bounds.middles.lower[axis];
  const float scale = static_cast<float>(kBins) / (range.bounds.middles.upper[axis] - from);
  const auto bin_of = [&](const Item& item) {
    const float x = (item.middle(axis) - from) * scale;
    return x >= static_cast<float>(kBins - 1) ? kBins - 1 : (x > 0 ? static_cast<std::size_t>(x) : 0);
  };
  std::array<ItemBounds, kBins> bins;
  std::array<std::size_t, kBins> counts{};
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const std::size_t bin = bin_of(items_[i]);
    bins[bin].add(items_[i]);
    ++counts[bin];
  }
  // cost[b]: the cost of all items in bins up to b on one side and the rest on the other.
  std::array<float, kBins> cost{};
  ItemBounds sum;
  std::size_t count = 0;
  for (std::size_t b = 0; b + 1 < kBins; ++b) {
    sum.extend(bins[b]);
    count += counts[b];
    cost[b] = count == 0 ? kFloatInfinity : sum.box.half_area() * static_cast<float>(count);
  }
  sum = {}, count = 0;
  // Of the costs above it, that of the best is complete.
  std::size_t best = kBins - 2;
  for (std::size_t b = kBins - 1; b > 0; --b) {
    sum.extend(bins[b]);
    count += counts[b];
    cost[b - 1] += count == 0 ? kFloatInfinity : sum.box.half_area() * static_cast<float>(count);
    if (cost[b - 1] <= cost[best]) best = b - 1;
  }
  const auto begin = items_.begin();
  const auto cut = std::partition(begin + static_cast<std::ptrdiff_t>(range.begin),
                                  begin + static_cast<std::ptrdiff_t>(range.end),
                                  [&](const Item& item) { return bin_of(item) <= best; });
  const auto middle = static_cast<std::size_t>(cut - begin);
  std::array<Range, 2> parts{Range{range.begin, middle, {}, range.depth + 1},
                             Range{middle, range.end, {}, range.depth + 1}};
  for (std::size_t b = 0; b < kBins; ++b) parts[b <= best ? 0 : 1].bounds.extend(bins[b]);
  return parts;
}

/// Divides a range in two halves of nearly equal size, so that the first fills its nodes or leaves.
std::array<NodeBuilder::Range, 2> NodeBuilder::halve(const Range& range, std::size_t axis) {
  const std::size_t unit = range.count() > node_size_ ? node_size_ : leaf_size_;
  const std::size_t units = (range.count() + unit - 1) / unit;
  const std::size_t middle = range.begin + (units + 1) / 2 * unit;
  const auto first = items_.begin();
  std::nth_element(first + static_cast<std::ptrdiff_t>(range.begin),
                   first + static_cast<std::ptrdiff_t>(middle),
                   first + static_cast<std::ptrdiff_t>(range.end), [axis](const Item& a, const Item& b) {
                     const float x = a.middle(axis), y = b.middle(axis);
                     return x != y ? x < y : a.number < b.number;
                   });
  std::array<Range, 2> parts{this->range(range.begin, middle), this->range(middle, range.end)};
  for (Range& part : parts) part.depth = range.depth + 1;
  return parts;
}

/// Builds a hierarchy group by group, and then the nodes that join the groups of each set.
class HierarchyBuilder {
 public:
  HierarchyBuilder(TriangleHierarchy& hierarchy, std::vector<std::uint32_t> starts)
      : hierarchy_(hierarchy), starts_(std::move(starts)) {}
  std::vector<Child> build(std::span<const std::vector<std::uint32_t>> sets);

 private:
  using Range = NodeBuilder::Range;
  using Deferred = NodeBuilder::Deferred;
  /// Stands for the parent of a range that is a whole group.
  static constexpr std::uint32_t kNoParent = 0xffffffffu;

  [[nodiscard]] std::size_t groups() const { return starts_.size() - 1; }
  void place_in_space();
  [[nodiscard]] Item item(std::uint32_t triangle) const;
  void build_groups();
  void build_deferred(NodeBuilder& builder, const std::vector<Deferred>& deferred);
  /// Parts of groups that are joined.
  struct Parts {
    std::vector<Item> items;  ///< with the numbers of children
    std::vector<Child> children;
  };
  void count_triangles();
  void add_parts(const Child& child, const Bounds& box, Parts& parts) const;
  Child join(std::span<const std::uint32_t> set, Nodes& joints) const;

  TriangleHierarchy& hierarchy_;
  std::vector<std::uint32_t> starts_;  ///< the places of group g are [starts_[g], starts_[g + 1])
  std::vector<Child> roots_;
  std::vector<Bounds> boxes_;         ///< by group
  std::vector<std::uint32_t> sizes_;  ///< by node
};

std::vector<Child> HierarchyBuilder::build(std::span<const std::vector<std::uint32_t>> sets) {
  place_in_space();
  build_groups();
  count_triangles();
  std::vector<Child> roots = roots_;
  Nodes joints;
  for (const auto& set : sets) roots.push_back(join(set, joints));
  Nodes& nodes = hierarchy_.nodes;
  nodes.reserve(nodes.size() + joints.size());
  nodes.insert(nodes.end(), joints.begin(), joints.end());
  return roots;
}

void HierarchyBuilder::place_in_space() {
  Box3& bounds = hierarchy_.bounds;
  for (const auto& t : hierarchy_.triangles) {
    for (const std::uint32_t v : t) {
      ADAMAS_ASSERT(v < hierarchy_.points.size());
      bounds.extend(hierarchy_.points[v]);
    }
  }
  if (hierarchy_.triangles.empty()) return;
  hierarchy_.center = 0.5 * bounds.min + 0.5 * bounds.max;
  const Vec3 half = 0.5 * bounds.max - 0.5 * bounds.min;
  const double reach = std::max({half.x, half.y, half.z});
  if (reach > 0) hierarchy_.scale = std::ldexp(1.0, -std::clamp(std::ilogb(reach), -1000, 1000));
}

Item HierarchyBuilder::item(std::uint32_t triangle) const {
  const auto corners = hierarchy_.corners(triangle);
  const Vec3 &low = hierarchy_.bounds.min, &high = hierarchy_.bounds.max;
  const Vec3 a = hierarchy_.to_local(corners[0]), b = hierarchy_.to_local(corners[1]),
             c = hierarchy_.to_local(corners[2]);
  Item item{{}, triangle, {}, 0};
  for (int axis = 0; axis < 3; ++axis) {
    // The pad covers the rounding errors of distances, which are computed from the untransformed coordinates.
    const double pad = 1e-15 * hierarchy_.scale * std::max(std::abs(low[axis]), std::abs(high[axis]));
    item.lower[axis] = below(std::min({a[axis], b[axis], c[axis]}) - pad);
    item.upper[axis] = above(std::max({a[axis], b[axis], c[axis]}) + pad);
  }
  return item;
}

void HierarchyBuilder::build_groups() {
  std::vector<Item> items(hierarchy_.order.size());
  parallel_for(items.size(), 8192, [&](std::size_t i) { items[i] = item(hierarchy_.order[i]); });
  NodeBuilder builder(items, TriangleHierarchy::kLeafSize);
  roots_.resize(groups());
  boxes_.resize(groups());
  std::vector<Deferred> deferred;
  for (std::size_t g = 0; g < groups(); ++g) {
    const Range range = builder.range(starts_[g], starts_[g + 1]);
    boxes_[g] = range.bounds.box;
    if (range.count() > TriangleHierarchy::kLeafSize && range.count() < kDeferBelow) {
      deferred.push_back({range, kNoParent, g});
    } else {
      roots_[g] = builder.build(range, hierarchy_.nodes, &deferred);
    }
  }
  build_deferred(builder, deferred);
  parallel_for(items.size(), 16384, [&](std::size_t i) {
    const std::uint32_t t = items[i].number;
    hierarchy_.order[i] = is_sliver(hierarchy_.corners(t)) ? t | TriangleHierarchy::kSliver : t;
  });
}

void HierarchyBuilder::build_deferred(NodeBuilder& builder, const std::vector<Deferred>& deferred) {
  std::vector<Nodes> parts(deferred.size());
  std::vector<Child> roots(deferred.size());
  parallel_for(deferred.size(), 1,
               [&](std::size_t i) { roots[i] = builder.build(deferred[i].range, parts[i], nullptr); });
  Nodes& nodes = hierarchy_.nodes;
  nodes.reserve(std::accumulate(parts.begin(), parts.end(), nodes.size(),
                                [](std::size_t sum, const Nodes& part) { return sum + part.size(); }));
  for (std::size_t i = 0; i < deferred.size(); ++i) {
    const auto offset = static_cast<std::uint32_t>(nodes.size());
    for (TriangleHierarchy::Node node : parts[i]) {
      for (std::size_t k = 0; k < TriangleHierarchy::kWidth; ++k) {
        if (node.count[k] == 0) node.first[k] += offset;
      }
      nodes.push_back(node);
    }
    release_memory(parts[i]);
    roots[i].first += offset;
    if (deferred[i].parent == kNoParent) {
      roots_[deferred[i].slot] = roots[i];
    } else {
      TriangleHierarchy::Node& parent = nodes[deferred[i].parent];
      parent.first[deferred[i].slot] = roots[i].first;
      parent.count[deferred[i].slot] = roots[i].count;
    }
  }
}

/// Finds the numbers of triangles below the groups' nodes.
void HierarchyBuilder::count_triangles() {
  sizes_.assign(hierarchy_.nodes.size(), 0);
  // Nodes come before those below them.
  for (std::size_t n = sizes_.size(); n-- > 0;) {
    for (std::size_t i = 0; i < TriangleHierarchy::kWidth; ++i) {
      const Child child = hierarchy_.nodes[n].child(i);
      if (child.count == TriangleHierarchy::kEmptySlot) continue;
      sizes_[n] += child.count == 0 ? sizes_[child.first] : child.count;
    }
  }
}

/// Divides a group into children that are joined with those of others. They are small, so that the boxes
/// above them overlap little, though groups may be spread over the whole.
void HierarchyBuilder::add_parts(const Child& child, const Bounds& box, Parts& parts) const {
  if (child.count != 0 || sizes_[child.first] <= kJoinedSize) {
    Item item{{}, static_cast<std::uint32_t>(parts.children.size()), {}, 0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      item.lower[axis] = box.lower[axis];
      item.upper[axis] = box.upper[axis];
    }
    parts.items.push_back(item);
    parts.children.push_back(child);
    return;
  }
  const TriangleHierarchy::Node& node = hierarchy_.nodes[child.first];
  for (std::size_t i = 0; i < TriangleHierarchy::kWidth; ++i) {
    if (node.count[i] == TriangleHierarchy::kEmptySlot) continue;
    Bounds part;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      part.lower[axis] = node.lower[axis][i];
      part.upper[axis] = node.upper[axis][i];
    }
    add_parts(node.child(i), part, parts);
  }
}

/// Appends to `joints`, which follow the nodes of the groups, those that join some groups; returns the root.
Child HierarchyBuilder::join(std::span<const std::uint32_t> set, Nodes& joints) const {
  std::vector<std::uint32_t> groups(set.begin(), set.end());
  std::erase_if(groups, [this](std::uint32_t g) { return roots_[g].count == TriangleHierarchy::kEmptySlot; });
  if (groups.empty()) return TriangleHierarchy::kNoChild;
  if (groups.size() == 1) return roots_[groups.front()];
  Parts parts;
  for (const std::uint32_t g : groups) add_parts(roots_[g], boxes_[g], parts);
  NodeBuilder builder(parts.items, 1);
  const std::size_t first = joints.size();
  const auto offset = static_cast<std::uint32_t>(hierarchy_.nodes.size());
  const Child root = builder.build(builder.range(0, parts.items.size()), joints, nullptr);
  for (std::size_t n = first; n < joints.size(); ++n) {
    for (std::size_t i = 0; i < TriangleHierarchy::kWidth; ++i) {
      if (joints[n].count[i] == 0) joints[n].first[i] += offset;
      if (joints[n].count[i] != 1) continue;
      const Child child = parts.children[parts.items[joints[n].first[i]].number];
      joints[n].first[i] = child.first;
      joints[n].count[i] = child.count;
    }
  }
  return {root.first + offset, 0};
}

}  // namespace

std::vector<TriangleHierarchy::Child> build_nodes(TriangleHierarchy& hierarchy, std::size_t groups,
                                                  const std::function<std::uint32_t(std::uint32_t)>& group_of,
                                                  std::span<const std::vector<std::uint32_t>> sets) {
  const auto count = static_cast<std::uint32_t>(hierarchy.triangles.size());
  const auto group = [&](std::uint32_t t) { return group_of ? group_of(t) : 0; };
  std::vector<std::uint32_t> starts(groups + 1, 0);
  for (std::uint32_t t = 0; t < count; ++t) ++starts[group(t) + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
  hierarchy.order.resize(count);
  for (std::uint32_t t = 0; t < count; ++t) hierarchy.order[next[group(t)]++] = t;
  return HierarchyBuilder(hierarchy, std::move(starts)).build(sets);
}

}  // namespace adamas::inline core
