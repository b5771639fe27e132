#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/geometry/vec3.h"

namespace adamas {

/// The nearest of a set of points.
struct NearestVertex {
  std::uint32_t index;
  double squared_distance;
};

/// A Kd-tree over distinct points, CGAL's, for the nearest one. Queries may run on several threads at once.
class VertexTree {
 public:
  explicit VertexTree(std::span<const Vec3> points);
  VertexTree(VertexTree&&) noexcept;
  VertexTree& operator=(VertexTree&&) noexcept;
  ~VertexTree();

  /// The nearest point with a distance of at most `max_distance`, of equally near ones that of the lowest
  /// index: what looking at every point in order finds, bit for bit. None where there is none, or q is not
  /// finite.
  [[nodiscard]] std::optional<NearestVertex> nearest(const Vec3& q, double max_distance) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace adamas
