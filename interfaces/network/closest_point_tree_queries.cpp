#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "interfaces/network/closest_point_tree.h"

namespace adamas {

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

/// Which side of an edge the ray passes on. Swapping the ends changes the sign and nothing else.
double edge_side(const Vec3& direction, const Vec3& a, const Vec3& b) { return dot(direction, cross(a, b)); }

bool hit_triangle(const Vec3& origin, const Vec3& direction, const std::array<Vec3, 3>& corners,
                  RayHit& hit) {
  const Vec3 a = corners[0] - origin, b = corners[1] - origin, c = corners[2] - origin;
  const double u = edge_side(direction, b, c);
  const double v = edge_side(direction, c, a);
  const double w = edge_side(direction, a, b);
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  const double sum = u + v + w;
  if (sum == 0) return false;
  const Vec3 point = (u / sum) * a + (v / sum) * b + (w / sum) * c;
  const double t = dot(point, direction) / squared_norm(direction);
  if (!(t >= 0)) return false;
  hit.t = t;
  hit.weights = {u / sum, v / sum, w / sum};
  return true;
}

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
        if (index_[i] == ignore || !hit_triangle(origin, direction, corners_[i], hit)) continue;
        if (hit.t > best.t || (hit.t == best.t && index_[i] > best.triangle)) continue;
        hit.triangle = index_[i];
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
        if (overlaps(corners_[k], box) && visit(index_[k])) return true;
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

}  // namespace adamas
