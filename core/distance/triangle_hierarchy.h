#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/large_pages.h"
#include "core/distance/triangle_distance.h"

namespace adamas::inline core {

/// Triangles on shared points, and boxes round groups of them in nodes with eight children: what trees of the
/// same triangles share (ClosestPointForest).
struct TriangleHierarchy {
  using Triangle = std::array<std::uint32_t, 3>;
  static constexpr int kWidth = 8;
  static constexpr std::uint32_t kLeafSize = 4;
  static constexpr std::uint32_t kEmptySlot = 0xffffffffu;
  static constexpr std::uint32_t kSliver = 0x80000000u;

  /// The node `first` if `count` is 0; nothing if it is kEmptySlot; else the triangles at places [first,
  /// first + count).
  struct Child {
    std::uint32_t first, count;  // without initial values, as searches have arrays of them
  };
  static constexpr Child kNoChild{0, kEmptySlot};
  /// The boxes are those of the points scale * (p - center), as floats that are rounded outwards.
  struct alignas(64) Node {
    float lower[3][kWidth];
    float upper[3][kWidth];
    std::uint32_t first[kWidth];
    std::uint32_t count[kWidth];
    [[nodiscard]] Child child(std::size_t i) const { return {first[i], count[i]}; }
  };

  [[nodiscard]] std::array<Vec3, 3> corners(std::uint32_t triangle) const {
    const Triangle& t = triangles[triangle];
    return {points[t[0]], points[t[1]], points[t[2]]};
  }
  [[nodiscard]] std::uint32_t triangle_at(std::size_t place) const { return order[place] & ~kSliver; }
  [[nodiscard]] bool is_sliver_at(std::size_t place) const { return (order[place] & kSliver) != 0; }
  /// The closest point of the triangle at a place.
  [[nodiscard]] TrianglePoint closest_at(std::size_t place, const Vec3& q) const {
    const std::array<Vec3, 3> at = corners(triangle_at(place));
    return is_sliver_at(place) ? detail::closest_on_sliver(q, at) : detail::closest_on_proper(q, at);
  }
  [[nodiscard]] Vec3 to_local(const Vec3& p) const { return scale * (p - center); }

  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<Node, LargePageAllocator<Node>> nodes;
  std::vector<std::uint32_t> order;  ///< the triangle at each place, with its flag kSliver
  Box3 bounds;                       ///< of all triangles
  Vec3 center;
  double scale = 1;  ///< a power of two
};

/// Builds the places and nodes of a hierarchy that has its points and triangles. `group_of`: the group of a
/// triangle, below `groups`; null if there is one group. `sets`: lists of groups. Returns the root of each
/// group's nodes and then that of each set's. The result does not depend on the number of threads.
std::vector<TriangleHierarchy::Child> build_nodes(TriangleHierarchy& hierarchy, std::size_t groups,
                                                  const std::function<std::uint32_t(std::uint32_t)>& group_of,
                                                  std::span<const std::vector<std::uint32_t>> sets);

}  // namespace adamas::inline core
