#include "core/distance/closest_point_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/simd.h"
#include "core/base/sort_unique.h"
#include "core/distance/closest_point_forest.h"

namespace adamas::inline core {

namespace {

using Node = TriangleHierarchy::Node;
constexpr std::size_t kWidth = TriangleHierarchy::kWidth;
constexpr std::size_t kStackSize = 1024;
constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

/// A float not greater than x; finite for finite x.
float round_down(double x) {
  const float f = static_cast<float>(std::clamp(x, -3e38, 3e38));
  return static_cast<double>(f) > x ? std::nextafter(f, -kFloatInfinity) : f;
}

using Lanes = Simd<float, 16>;

/// Squared distances between the boxes of a node's children and a box round a point, and a bit for each child
/// that is within the bound.
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

/// Asks for the points of a leaf's triangles at once, since they are far apart in memory.
void prefetch_leaf(const TriangleHierarchy& hierarchy, const TriangleHierarchy::Child& leaf) {
  for (std::uint32_t place = leaf.first; place < leaf.first + leaf.count; ++place) {
    for (const std::uint32_t p : hierarchy.triangles[hierarchy.triangle_at(place)])
      __builtin_prefetch(&hierarchy.points[p]);
  }
}

/// A bound for squared distances to boxes in float: greater by every rounding error of computing them.
float box_bound(double squared_distance, double scale) {
  const double scaled = squared_distance * scale * scale;
  return scaled < 1e38 ? static_cast<float>(scaled * (1 + 1e-6) + 1e-44) : kFloatInfinity;
}

}  // namespace

ClosestPointTree::ClosestPointTree(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  std::vector<Triangle> copies(triangles.begin(), triangles.end());
  if (points.size() <= 3 * triangles.size()) {
    *this = ClosestPointForest({points.begin(), points.end()}, std::move(copies)).all();
    return;
  }
  // Most of these points belong to other triangles.
  std::vector<std::uint32_t> used;
  for (const Triangle& t : copies) used.insert(used.end(), t.begin(), t.end());
  sort_unique(used);
  std::vector<Vec3> own;
  own.reserve(used.size());
  for (const std::uint32_t p : used) own.push_back(points[p]);
  for (Triangle& t : copies) {
    for (std::uint32_t& p : t)
      p = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), p) - used.begin());
  }
  *this = ClosestPointForest(std::move(own), std::move(copies)).all();
}

std::vector<std::uint32_t> ClosestPointTree::indices() const {
  std::vector<std::uint32_t> result;
  if (empty()) return result;
  std::vector<std::uint64_t> is_in(hierarchy_->triangles.size() / 64 + 1, 0);
  for_each_triangle(whole(), [&](std::uint32_t t) { is_in[t / 64] |= std::uint64_t{1} << (t % 64); });
  result.reserve(count_);
  for (std::size_t word = 0; word < is_in.size(); ++word) {
    for (std::uint64_t bits = is_in[word]; bits != 0; bits &= bits - 1)
      result.push_back(
          static_cast<std::uint32_t>(64 * word + static_cast<std::size_t>(std::countr_zero(bits))));
  }
  return result;
}

void ClosestPointTree::divide(const Group& group, std::vector<Group>& parts) const {
  ADAMAS_ASSERT(!is_leaf(group));
  const TriangleHierarchy& h = *hierarchy_;
  const Node& node = h.nodes[group.child.first];
  // The pad covers the rounding errors of the change of coordinates.
  const double pad = 1e-15 * std::max(norm(h.bounds.min), norm(h.bounds.max));
  for (std::size_t i = 0; i < kWidth; ++i) {
    if (node.count[i] == TriangleHierarchy::kEmptySlot) continue;
    Group part{{}, node.child(i)};
    for (int axis = 0; axis < 3; ++axis) {
      part.box.min[axis] = h.center[axis] + static_cast<double>(node.lower[axis][i]) / h.scale - pad;
      part.box.max[axis] = h.center[axis] + static_cast<double>(node.upper[axis][i]) / h.scale + pad;
    }
    parts.push_back(part);
  }
}

std::span<const Vec3> ClosestPointTree::points() const {
  return hierarchy_ ? std::span<const Vec3>(hierarchy_->points) : std::span<const Vec3>();
}

std::span<const ClosestPointTree::Triangle> ClosestPointTree::triangles() const {
  return hierarchy_ ? std::span<const Triangle>(hierarchy_->triangles) : std::span<const Triangle>();
}

std::size_t ClosestPointTree::memory_bytes() const {
  if (!hierarchy_) return 0;
  const TriangleHierarchy& h = *hierarchy_;
  return h.nodes.capacity() * sizeof(h.nodes[0]) + h.points.capacity() * sizeof(Vec3) +
         h.triangles.capacity() * sizeof(Triangle) + h.order.capacity() * sizeof(std::uint32_t);
}

template <class Visit>
void ClosestPointTree::visit_near(const Vec3& q, double squared_distance, Visit&& visit) const {
  const TriangleHierarchy& h = *hierarchy_;
  const Vec3 local = h.to_local(q);
  if (!is_finite(local)) return;
  Lanes::Numbers low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = Lanes::Numbers{} + round_down(local[axis]);
    high[axis] = Lanes::Numbers{} - round_down(-local[axis]);
  }

  float bound = box_bound(squared_distance, h.scale);
  struct Entry {
    float squared_distance;
    Child child;
  };
  Entry stack[kStackSize];
  std::size_t top = 0;
  Entry entry{0, root_};
  while (true) {
    if (entry.child.count == 0) {
      const Node& node = h.nodes[entry.child.first];
      alignas(16) float distances[kWidth];
      const std::size_t base = top;
      for (unsigned hits = children_within(node, low, high, bound, distances); hits != 0; hits &= hits - 1) {
        const auto i = static_cast<unsigned>(__builtin_ctz(hits));
        if (node.count[i] == TriangleHierarchy::kEmptySlot) continue;
        // Entries are sorted with the farthest first.
        std::size_t place = top++;
        for (; place > base && stack[place - 1].squared_distance < distances[i]; --place) {
          stack[place] = stack[place - 1];
        }
        stack[place] = {distances[i], node.child(i)};
      }
      ADAMAS_ASSERT(top + kWidth <= kStackSize);
    } else {
      prefetch_leaf(h, entry.child);
      for (std::uint32_t i = entry.child.first; i < entry.child.first + entry.child.count; ++i) {
        if (!visit(i, squared_distance)) return;
      }
      bound = box_bound(squared_distance, h.scale);
    }
    do {
      if (top == 0) return;
      entry = stack[--top];
    } while (entry.squared_distance > bound);
  }
}

/// Finds a triangle that is closer to q, or as close and of a lower index.
void ClosestPointTree::improve(const Vec3& q, ClosestPoint& best) const {
  visit_near(q, best.squared_distance, [&](std::uint32_t place, double& bound) {
    const std::uint32_t t = hierarchy_->triangle_at(place);
    const TrianglePoint p = hierarchy_->closest_at(place, q);
    if (p.squared_distance > best.squared_distance) return true;
    if (p.squared_distance == best.squared_distance && t > best.triangle) return true;
    best = {p.point, p.squared_distance, t, p.feature};
    bound = best.squared_distance;
    return true;
  });
}

std::optional<ClosestPoint> ClosestPointTree::closest(const Vec3& q, double max_distance) const {
  if (empty() || !(max_distance >= 0)) return std::nullopt;
  ClosestPoint best;
  best.squared_distance = max_distance * max_distance;
  improve(q, best);
  if (best.triangle == kNoTriangle) return std::nullopt;
  return best;
}

std::optional<ClosestPoint> ClosestPointTree::closest_from(const Vec3& q, std::uint32_t guess) const {
  if (guess == kNoTriangle || !is_finite(q)) return closest(q);
  const TrianglePoint p = closest_on_triangle(q, hierarchy_->corners(guess));
  ClosestPoint best{p.point, p.squared_distance, guess, p.feature};
  improve(q, best);
  return best;
}

bool ClosestPointTree::is_within(const Vec3& q, double max_distance) const {
  if (empty() || !(max_distance >= 0)) return false;
  bool found = false;
  visit_near(q, max_distance * max_distance, [&](std::uint32_t place, double bound) {
    found = hierarchy_->closest_at(place, q).squared_distance <= bound;
    return !found;
  });
  return found;
}

void ClosestPointTree::validate() const {
  if (empty()) return;
  std::vector<char> seen(hierarchy_->order.size(), 0);
  const double infinity = std::numeric_limits<double>::infinity();
  validate(root_, {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}}, seen);
  const auto count = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), 1));
  if (count != count_) fail("closest-point tree: expected {} triangles in leaves, found {}", count_, count);
  for (std::size_t place = 0; place < seen.size(); ++place) {
    if (seen[place] == 0) continue;
    for (const Vec3& corner : hierarchy_->corners(hierarchy_->triangle_at(place))) {
      if (!bounds_.contains(corner)) fail("closest-point tree: place {} is outside the tree's box", place);
    }
  }
}

void ClosestPointTree::validate(Child child, const Box3& within, std::vector<char>& seen) const {
  if (child.count == 0) {
    const Node& node = hierarchy_->nodes[child.first];
    for (std::size_t i = 0; i < kWidth; ++i) {
      if (node.count[i] == TriangleHierarchy::kEmptySlot) continue;
      Box3 box;
      box.extend({node.lower[0][i], node.lower[1][i], node.lower[2][i]});
      box.extend({node.upper[0][i], node.upper[1][i], node.upper[2][i]});
      if (!within.contains(box.min) || !within.contains(box.max))
        fail("closest-point tree: child {} of node {} is outside its node's box", i, child.first);
      validate(node.child(i), box, seen);
    }
    return;
  }
  for (std::uint32_t place = child.first; place < child.first + child.count; ++place) {
    if (seen[place] != 0) fail("closest-point tree: place {} is in two leaves", place);
    seen[place] = 1;
    for (const Vec3& corner : hierarchy_->corners(hierarchy_->triangle_at(place))) {
      if (!within.contains(hierarchy_->to_local(corner)))
        fail("closest-point tree: place {} is outside its box", place);
    }
  }
}

namespace {

/// Narrows [from, to] to the range of t in which a ray is inside a slab. `inverse`: of the ray's direction;
/// where it is not finite, a range that is not known is not narrowed.
void clip_to_slab(double origin, double direction, double inverse, double lower, double upper, double& from,
                  double& to) {
  if (direction == 0) {
    if (origin < lower || origin > upper) to = -1;
    return;
  }
  double enter = (lower - origin) * inverse;
  double leave = (upper - origin) * inverse;
  if (enter > leave) std::swap(enter, leave);
  const double slack = 1e-12 * std::max(std::abs(enter), std::abs(leave));
  from = std::max(from, enter - slack);
  to = std::min(to, leave + slack);
}

/// Finds the box round a ray from its origin to `t`.
void box_of_ray(const Vec3& origin, const Vec3& direction, double t, Lanes::Numbers (&low)[3],
                Lanes::Numbers (&high)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    const double reach = direction[axis] == 0 ? 0 : t * direction[axis];
    const double slack = 1e-12 * std::abs(reach), end = origin[axis] + reach;
    low[axis] = Lanes::Numbers{} + round_down(std::min(origin[axis], end) - slack);
    high[axis] = Lanes::Numbers{} - round_down(-std::max(origin[axis], end) - slack);
  }
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
  if (empty()) return std::nullopt;
  const TriangleHierarchy& h = *hierarchy_;
  const Vec3 local = h.to_local(origin);
  const Vec3 step = h.scale * direction, inverse{1 / step.x, 1 / step.y, 1 / step.z};
  const ShearedRay ray(origin, direction);
  RayHit best;
  best.t = max_t;
  Lanes::Numbers low[3], high[3];
  box_of_ray(local, step, best.t, low, high);
  struct Entry {
    double t;
    Child child;
  };
  std::array<Entry, kStackSize> stack;
  std::size_t top = 0;
  stack[top++] = {0, root_};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.t > best.t) continue;
    if (entry.child.count > 0) {
      for (std::uint32_t i = entry.child.first; i < entry.child.first + entry.child.count; ++i) {
        const std::uint32_t t = h.triangle_at(i);
        RayHit hit;
        if (t == ignore || !ray.hits(h.corners(t), hit)) continue;
        if (hit.t > best.t || (hit.t == best.t && t > best.triangle)) continue;
        hit.triangle = t;
        best = hit;
        box_of_ray(local, step, best.t, low, high);
      }
      continue;
    }
    const Node& node = h.nodes[entry.child.first];
    const std::size_t base = top;
    alignas(16) float distances[kWidth];
    for (unsigned hits = children_within(node, low, high, 0, distances); hits != 0; hits &= hits - 1) {
      const auto i = static_cast<unsigned>(__builtin_ctz(hits));
      if (node.count[i] == TriangleHierarchy::kEmptySlot) continue;
      double from = 0, to = best.t;
      for (int axis = 0; axis < 3; ++axis) {
        clip_to_slab(local[axis], step[axis], inverse[axis], node.lower[axis][i], node.upper[axis][i], from,
                     to);
      }
      if (from > to) continue;
      std::size_t place = top++;
      for (; place > base && stack[place - 1].t < from; --place) stack[place] = stack[place - 1];
      stack[place] = {from, node.child(i)};
    }
    ADAMAS_ASSERT(top + kWidth <= kStackSize);
  }
  if (best.triangle == kNoTriangle) return std::nullopt;
  return best;
}

template <class Visit>
bool ClosestPointTree::visit_overlapping(const Box3& box, Visit&& visit) const {
  if (empty()) return false;
  const TriangleHierarchy& h = *hierarchy_;
  const Vec3 low = h.to_local(box.min), high = h.to_local(box.max);
  std::vector<Child> stack{root_};
  while (!stack.empty()) {
    const Child child = stack.back();
    stack.pop_back();
    for (std::uint32_t place = child.first; place < child.first + child.count; ++place) {
      const std::uint32_t t = h.triangle_at(place);
      if (overlaps(h.corners(t), box) && visit(t)) return true;
    }
    if (child.count > 0) continue;
    const Node& node = h.nodes[child.first];
    for (std::size_t i = 0; i < kWidth; ++i) {
      if (node.count[i] == TriangleHierarchy::kEmptySlot) continue;
      bool apart = false;
      for (int axis = 0; axis < 3; ++axis) {
        apart = apart || static_cast<double>(node.lower[axis][i]) > high[axis] ||
                static_cast<double>(node.upper[axis][i]) < low[axis];
      }
      if (!apart) stack.push_back(node.child(i));
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
