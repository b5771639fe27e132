#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "core/distance/closest_point_tree.h"

namespace adamas::inline core {

namespace {

/// Range of t in which a ray is inside a slab; narrows [from, to].
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

/// Sheared along its greatest component, a ray becomes an axis and the question one about triangles in the
/// plane round the origin, which signs answer exactly (Woop, Benthin and Wald 2013): neighbours agree on
/// their common edge.
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

/// Whether the projections of box (about the origin, with half sizes) and triangle on an axis are apart.
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
