#include "core/distance/closest_point_tree.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"
#include "core/distance/closest_point_tree_builder.h"

namespace adamas::inline core {

namespace {

constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

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

/// Bound for squared distances to boxes in float: above every rounding error of computing them.
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
        // Entries are kept with the farthest first.
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
  std::vector<char> seen(size(), 0);
  const double infinity = std::numeric_limits<double>::infinity();
  if (!nodes_.empty()) {
    validate_node(0, {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}}, seen);
  }
  const auto missing = std::find(seen.begin(), seen.end(), 0);
  if (missing != seen.end()) fail("closest-point tree: place {} is in no leaf", missing - seen.begin());
  for (std::size_t i = 0; i < size(); ++i) {
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

}  // namespace adamas::inline core
