#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/vec3.h"

namespace adamas {

/// The nearest of a set of points.
struct NearestVertex {
  std::uint32_t index;
  double squared_distance;
};

/// A k-d tree over finite points, for the nearest one. Queries may run on several threads at once.
class VertexTree {
 public:
  VertexTree() = default;
  explicit VertexTree(std::span<const Vec3> points);

  /// The nearest point with a distance of at most `max_distance`, of equally near ones that of the lowest
  /// index: what looking at every point in order finds, bit for bit. None where there is none, or q is not
  /// finite.
  [[nodiscard]] std::optional<NearestVertex> nearest(const Vec3& q, double max_distance) const;

 private:
  struct Vertex {
    Vec3 point;
    std::uint32_t index;
    /// Where this vertex is the middle of a part of the tree: no vertex before it is above it along this
    /// axis, and none after it below.
    std::uint8_t axis;
  };
  void build(std::size_t begin, std::size_t end);

  /// The root is in the middle, and those of its two halves in theirs; parts with few vertices are in no
  /// order.
  std::vector<Vertex> vertices_;
};

}  // namespace adamas
