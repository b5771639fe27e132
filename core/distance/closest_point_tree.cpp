#include "core/distance/closest_point_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"

namespace adamas::inline core {

namespace {

constexpr std::size_t kDeferBelow = 16384;
constexpr int kBins = 16;
// Deeper ranges are halved, which bounds the depth on the most lopsided input.
constexpr int kMedianDepth = 60;
constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

/// A float less than x.
float below(double x) {
  const float f = static_cast<float>(std::clamp(x, -3e38, 3e38));
  return std::nextafter(f, -kFloatInfinity);
}

/// A float greater than x.
float above(double x) { return -below(-x); }

/// Twice the centre of a box, which orders boxes as the centre does.
float middle(const std::array<float, 3>& lower, const std::array<float, 3>& upper, int axis) {
  const auto k = static_cast<std::size_t>(axis);
  return lower[k] + upper[k];
}

}  // namespace

/// Builds the nodes of a ClosestPointTree from the top, by binned surface area. Ranges below a fixed size are
/// built in parallel and joined in order, so that the tree does not depend on the number of threads.
class ClosestPointTreeBuilder {
 public:
  /// `tree` has its bounds, centre and scale; sets its nodes and `index_`.
  ClosestPointTreeBuilder(ClosestPointTree& tree, std::span<const Vec3> points,
                          std::span<const ClosestPointTree::Triangle> triangles);
  void build();

 private:
  struct FloatBox {
    std::array<float, 3> lower, upper;
    static FloatBox empty();
    void extend(const FloatBox& b);
    [[nodiscard]] float half_area() const;
  };
  struct Item {
    FloatBox box;
    std::uint32_t triangle;
  };
  struct Range {
    std::size_t begin, end;
    FloatBox box;
    int depth;
    [[nodiscard]] std::size_t count() const { return end - begin; }
  };
  /// A range whose nodes are built later; its root belongs in child `slot` of node `parent`.
  struct Deferred {
    Range range;
    std::uint32_t parent;
    int slot;
  };
  using Nodes = ClosestPointTree::Nodes;

  [[nodiscard]] FloatBox box_of(const ClosestPointTree::Triangle& t) const;
  [[nodiscard]] FloatBox box_of_items(std::size_t begin, std::size_t end) const;
  /// Orders the items of a range and divides it in two parts, none of them empty.
  std::array<Range, 2> split(const Range& range);
  std::size_t partition(const Range& range, int axis, float from, float to);
  std::uint32_t build_node(const Range& range, Nodes& nodes, std::vector<Deferred>* deferred);
  void build_deferred(const std::vector<Deferred>& deferred);

  ClosestPointTree& tree_;
  std::span<const Vec3> points_;
  std::span<const ClosestPointTree::Triangle> triangles_;
  std::vector<Item> items_;
};

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
    // The pad covers the rounding errors of distances, which are computed from the untransformed coordinates.
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
  // cost[b]: the cost of all items in bins up to b on one side and the rest on the other.
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

namespace {

/// A float not greater than x; finite for finite x.
float round_down(double x) {
  const float f = static_cast<float>(std::clamp(x, -3e38, 3e38));
  return static_cast<double>(f) > x ? std::nextafter(f, -kFloatInfinity) : f;
}

using Lanes = Simd<float, 16>;

/// Squared distances between the boxes of a node's children and a box round a point, and a bit for each child
/// that is within the bound.
template <class Node, std::size_t kWidth>
unsigned children_within(const Node& node, const Lanes::Numbers (&low)[3], const Lanes::Numbers (&high)[3],
                         float bound, float (&distances)[kWidth]) {
  using Numbers = Lanes::Numbers;
  unsigned hits = 0;
  for (std::size_t half = 0; half < kWidth; half += Lanes::kCount) {
    Numbers sum{};
    for (int axis = 0; axis < 3; ++axis) {
      const Numbers under = Lanes::load(node.lower[axis] + half) - high[axis];
      const Numbers over = low[axis] - Lanes::load(node.upper[axis] + half);
      const Numbers gap = Lanes::greater(Lanes::greater(under, over), Numbers{});
      sum += gap * gap;
    }
    Lanes::store(sum, distances + half);
    hits |= bits_not_greater(sum, Numbers{} + bound) << half;
  }
  return hits;
}

/// A bound for squared distances to boxes in float: greater by every rounding error of computing them.
float box_bound(double squared_distance, double scale) {
  const double scaled = squared_distance * scale * scale;
  return scaled < 1e38 ? static_cast<float>(scaled * (1 + 1e-6) + 1e-44) : kFloatInfinity;
}

}  // namespace

ClosestPointTree::ClosestPointTree(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  if (triangles.empty()) return;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) {
      ADAMAS_ASSERT(v < points.size());
      bounds_.extend(points[v]);
    }
  }
  center_ = 0.5 * bounds_.min + 0.5 * bounds_.max;
  const Vec3 half = 0.5 * bounds_.max - 0.5 * bounds_.min;
  const double reach = std::max({half.x, half.y, half.z});
  if (reach > 0) scale_ = std::ldexp(1.0, -std::clamp(std::ilogb(reach), -1000, 1000));

  ClosestPointTreeBuilder(*this, points, triangles).build();
  corners_.resize(index_.size());
  place_.resize(index_.size());
  parallel_for(index_.size(), 16384, [&](std::size_t i) {
    const Triangle& t = triangles[index_[i]];
    corners_[i] = {points[t[0]], points[t[1]], points[t[2]]};
    place_[index_[i]] = static_cast<std::uint32_t>(i);
    if (is_sliver(corners_[i])) index_[i] |= kSliver;
  });
}

std::size_t ClosestPointTree::memory_bytes() const {
  return nodes_.capacity() * sizeof(Node) + corners_.capacity() * sizeof(corners_[0]) +
         (index_.capacity() + place_.capacity()) * sizeof(std::uint32_t);
}

std::optional<ClosestPoint> ClosestPointTree::closest(const Vec3& q, double max_distance) const {
  if (nodes_.empty() || !(max_distance >= 0)) return std::nullopt;
  const Vec3 local = to_tree(q);
  if (!std::isfinite(local.x) || !std::isfinite(local.y) || !std::isfinite(local.z)) return std::nullopt;
  Lanes::Numbers low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = Lanes::Numbers{} + round_down(local[axis]);
    high[axis] = Lanes::Numbers{} - round_down(-local[axis]);
  }

  ClosestPoint best;
  best.squared_distance = max_distance * max_distance;
  float bound = box_bound(best.squared_distance, scale_);
  struct Entry {
    float squared_distance;
    std::uint32_t first, count;
  };
  Entry stack[kStackSize];
  std::size_t top = 0;
  Entry entry{0, 0, 0};
  while (true) {
    if (entry.count == 0) {
      const Node& node = nodes_[entry.first];
      alignas(16) float distances[kWidth];
      const std::size_t base = top;
      for (unsigned hits = children_within(node, low, high, bound, distances); hits != 0; hits &= hits - 1) {
        const auto i = static_cast<unsigned>(__builtin_ctz(hits));
        if (node.count[i] == kEmptySlot) continue;
        // Entries are sorted with the farthest first.
        std::size_t place = top++;
        for (; place > base && stack[place - 1].squared_distance < distances[i]; --place) {
          stack[place] = stack[place - 1];
        }
        stack[place] = {distances[i], node.first[i], node.count[i]};
      }
      ADAMAS_ASSERT(top + kWidth <= kStackSize);
    } else {
      for (std::uint32_t i = entry.first; i < entry.first + entry.count; ++i) {
        const bool sliver = (index_[i] & kSliver) != 0;
        const TrianglePoint p =
            sliver ? detail::closest_on_sliver(q, corners_[i]) : detail::closest_on_proper(q, corners_[i]);
        if (p.squared_distance > best.squared_distance) continue;
        if (p.squared_distance == best.squared_distance && index(i) > best.triangle) continue;
        best = {p.point, p.squared_distance, index(i), p.feature};
        bound = box_bound(best.squared_distance, scale_);
      }
    }
    do {
      if (top == 0) {
        if (best.triangle == kNoTriangle) return std::nullopt;
        return best;
      }
      entry = stack[--top];
    } while (entry.squared_distance > bound);
  }
}

void ClosestPointTree::validate() const {
  std::vector<char> seen(corners_.size(), 0);
  const double infinity = std::numeric_limits<double>::infinity();
  if (!nodes_.empty()) {
    validate_node(0, {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}}, seen);
  }
  const auto missing = std::find(seen.begin(), seen.end(), 0);
  if (missing != seen.end()) fail("closest-point tree: place {} is in no leaf", missing - seen.begin());
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    if (place_[index(i)] != i) fail("closest-point tree: place {} has the wrong triangle index", i);
  }
}

void ClosestPointTree::validate_node(std::uint32_t id, const Box3& within, std::vector<char>& seen) const {
  const Node& node = nodes_[id];
  for (int i = 0; i < kWidth; ++i) {
    if (node.count[i] == kEmptySlot) continue;
    Box3 box;
    box.extend({node.lower[0][i], node.lower[1][i], node.lower[2][i]});
    box.extend({node.upper[0][i], node.upper[1][i], node.upper[2][i]});
    if (!within.contains(box.min) || !within.contains(box.max)) {
      fail("closest-point tree: child {} of node {} is outside its node's box", i, id);
    }
    if (node.count[i] == 0) {
      validate_node(node.first[i], box, seen);
      continue;
    }
    for (std::uint32_t k = node.first[i]; k < node.first[i] + node.count[i]; ++k) {
      if (seen[k] != 0) fail("closest-point tree: place {} is in two leaves", k);
      seen[k] = 1;
      for (const Vec3& corner : corners_[k]) {
        if (!box.contains(to_tree(corner))) fail("closest-point tree: place {} is outside its box", k);
      }
    }
  }
}

namespace {

/// The range of t in which a ray is inside a slab; narrows [from, to].
void clip_to_slab(double origin, double direction, double lower, double upper, double& from, double& to) {
  if (direction == 0) {
    if (origin < lower || origin > upper) to = -1;
    return;
  }
  double enter = (lower - origin) / direction;
  double leave = (upper - origin) / direction;
  if (enter > leave) std::swap(enter, leave);
  const double slack = 1e-12 * std::max(std::abs(enter), std::abs(leave));
  from = std::max(from, enter - slack);
  to = std::min(to, leave + slack);
}

/// a b - c d, with the exact sign.
double difference_of_products(double a, double b, double c, double d) {
  const double p = a * b, q = c * d;
  return p != q ? p - q : std::fma(a, b, -p) - std::fma(c, d, -q);
}

/// The ray is sheared along its greatest component and becomes an axis; then the question is one about
/// triangles in the plane round the origin, which signs answer exactly (Woop, Benthin and Wald 2013), so that
/// neighbours agree on their common edge.
class ShearedRay {
 public:
  ShearedRay(const Vec3& origin, const Vec3& direction) : origin_(origin) {
    const Vec3 size{std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)};
    z_ = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    x_ = (z_ + 1) % 3;
    y_ = (z_ + 2) % 3;
    scale_ = 1 / direction[z_];
    shear_x_ = direction[x_] * scale_;
    shear_y_ = direction[y_] * scale_;
  }

  bool hits(const std::array<Vec3, 3>& corners, RayHit& hit) const {
    const Vec3 a = shear(corners[0]), b = shear(corners[1]), c = shear(corners[2]);
    const double u = difference_of_products(c.x, b.y, c.y, b.x);
    const double v = difference_of_products(a.x, c.y, a.y, c.x);
    const double w = difference_of_products(b.x, a.y, b.y, a.x);
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
    const double sum = u + v + w;
    if (sum == 0) return false;
    hit.weights = {u / sum, v / sum, w / sum};
    hit.t = scale_ * (hit.weights[0] * a.z + hit.weights[1] * b.z + hit.weights[2] * c.z);
    return hit.t >= 0;
  }

 private:
  [[nodiscard]] Vec3 shear(const Vec3& p) const {
    const Vec3 local = p - origin_;
    return {local[x_] - shear_x_ * local[z_], local[y_] - shear_y_ * local[z_], local[z_]};
  }

  Vec3 origin_;
  int x_, y_, z_;
  double scale_, shear_x_, shear_y_;
};

/// Whether an axis separates the projections of a box (about the origin, with half sizes) and a triangle.
bool separated(const Vec3& axis, const std::array<Vec3, 3>& corners, const Vec3& half) {
  const double a = dot(axis, corners[0]), b = dot(axis, corners[1]), c = dot(axis, corners[2]);
  const double reach = half.x * std::abs(axis.x) + half.y * std::abs(axis.y) + half.z * std::abs(axis.z);
  return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
}

}  // namespace

bool overlaps(const std::array<Vec3, 3>& corners, const Box3& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
    if (low > box.max[axis] || high < box.min[axis]) return false;
  }
  const Vec3 center = box.center(), half = 0.5 * box.size();
  const std::array<Vec3, 3> local{corners[0] - center, corners[1] - center, corners[2] - center};
  const std::array<Vec3, 3> edges{local[1] - local[0], local[2] - local[1], local[0] - local[2]};
  if (separated(cross(edges[0], edges[1]), local, half)) return false;
  for (const Vec3& e : edges) {
    if (separated({0, -e.z, e.y}, local, half) || separated({e.z, 0, -e.x}, local, half) ||
        separated({-e.y, e.x, 0}, local, half)) {
      return false;
    }
  }
  return true;
}

std::optional<RayHit> ClosestPointTree::first_hit(const Vec3& origin, const Vec3& direction, double max_t,
                                                  std::uint32_t ignore) const {
  if (nodes_.empty()) return std::nullopt;
  const Vec3 local = to_tree(origin);
  const Vec3 step = scale_ * direction;
  const ShearedRay ray(origin, direction);
  RayHit best;
  best.t = max_t;
  struct Entry {
    double t;
    std::uint32_t first, count;
  };
  std::array<Entry, kStackSize> stack;
  std::size_t top = 0;
  stack[top++] = {0, 0, 0};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.t > best.t) continue;
    if (entry.count > 0) {
      for (std::uint32_t i = entry.first; i < entry.first + entry.count; ++i) {
        RayHit hit;
        if (index(i) == ignore || !ray.hits(corners_[i], hit)) continue;
        if (hit.t > best.t || (hit.t == best.t && index(i) > best.triangle)) continue;
        hit.triangle = index(i);
        best = hit;
      }
      continue;
    }
    const Node& node = nodes_[entry.first];
    const std::size_t base = top;
    for (int i = 0; i < kWidth; ++i) {
      if (node.count[i] == kEmptySlot) continue;
      double from = 0, to = best.t;
      for (int axis = 0; axis < 3; ++axis) {
        clip_to_slab(local[axis], step[axis], node.lower[axis][i], node.upper[axis][i], from, to);
      }
      if (from > to) continue;
      std::size_t place = top++;
      for (; place > base && stack[place - 1].t < from; --place) stack[place] = stack[place - 1];
      stack[place] = {from, node.first[i], node.count[i]};
    }
    ADAMAS_ASSERT(top + kWidth <= kStackSize);
  }
  if (best.triangle == kNoTriangle) return std::nullopt;
  return best;
}

template <class Visit>
bool ClosestPointTree::visit_overlapping(const Box3& box, Visit&& visit) const {
  if (nodes_.empty()) return false;
  const Vec3 low = to_tree(box.min), high = to_tree(box.max);
  std::vector<std::uint32_t> stack{0};
  while (!stack.empty()) {
    const Node& node = nodes_[stack.back()];
    stack.pop_back();
    for (int i = 0; i < kWidth; ++i) {
      if (node.count[i] == kEmptySlot) continue;
      bool apart = false;
      for (int axis = 0; axis < 3; ++axis) {
        apart = apart || static_cast<double>(node.lower[axis][i]) > high[axis] ||
                static_cast<double>(node.upper[axis][i]) < low[axis];
      }
      if (apart) continue;
      if (node.count[i] == 0) {
        stack.push_back(node.first[i]);
        continue;
      }
      for (std::uint32_t k = node.first[i]; k < node.first[i] + node.count[i]; ++k) {
        if (overlaps(corners_[k], box) && visit(index(k))) return true;
      }
    }
  }
  return false;
}

bool ClosestPointTree::any_overlap(const Box3& box) const {
  return visit_overlapping(box, [](std::uint32_t) { return true; });
}

void ClosestPointTree::overlapping(const Box3& box, std::vector<std::uint32_t>& out) const {
  out.clear();
  visit_overlapping(box, [&out](std::uint32_t triangle) {
    out.push_back(triangle);
    return false;
  });
  std::sort(out.begin(), out.end());
}

}  // namespace adamas::inline core
