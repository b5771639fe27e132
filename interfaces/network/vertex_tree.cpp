#include "interfaces/network/vertex_tree.h"

#include <algorithm>
#include <cmath>

namespace adamas {

namespace {

constexpr std::size_t kLeafSize = 8;

}  // namespace

VertexTree::VertexTree(std::span<const Vec3> points) {
  vertices_.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) vertices_.push_back({points[i], i, 0});
  build(0, vertices_.size());
}

void VertexTree::build(std::size_t begin, std::size_t end) {
  if (end - begin <= kLeafSize) return;
  Box3 bounds;
  for (std::size_t i = begin; i < end; ++i) bounds.extend(vertices_[i].point);
  const Vec3 size = bounds.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [this](std::size_t i) { return vertices_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [axis](const Vertex& a, const Vertex& b) {
    return a.point[axis] != b.point[axis] ? a.point[axis] < b.point[axis] : a.index < b.index;
  });
  vertices_[middle].axis = static_cast<std::uint8_t>(axis);
  build(begin, middle);
  build(middle + 1, end);
}

std::optional<NearestVertex> VertexTree::nearest(const Vec3& q, double max_distance) const {
  if (!std::isfinite(q.x) || !std::isfinite(q.y) || !std::isfinite(q.z)) return std::nullopt;
  std::optional<NearestVertex> best;
  double bound = max_distance * max_distance;
  const auto consider = [&](const Vertex& v) {
    const double d = squared_norm(q - v.point);
    if (d < bound || (d == bound && (!best || v.index < best->index))) {
      best = {v.index, d};
      bound = d;
    }
  };
  /// A part of the tree, and how far q is from it along each axis, at least. Differences, squares and sums
  /// are rounded in the same way as those of its vertices, and so are never greater.
  struct Part {
    std::size_t begin, end;
    Vec3 gap;
  };
  Part stack[64];
  std::size_t size = 0;
  stack[size++] = {0, vertices_.size(), {}};
  while (size > 0) {
    const Part part = stack[--size];
    if (squared_norm(part.gap) > bound) continue;
    if (part.end - part.begin <= kLeafSize) {
      for (std::size_t i = part.begin; i < part.end; ++i) consider(vertices_[i]);
      continue;
    }
    const std::size_t middle = part.begin + (part.end - part.begin) / 2;
    const Vertex& v = vertices_[middle];
    consider(v);
    const double beyond = q[v.axis] - v.point[v.axis];
    Part before{part.begin, middle, part.gap}, after{middle + 1, part.end, part.gap};
    (beyond < 0 ? after : before).gap[v.axis] = beyond;
    stack[size++] = beyond < 0 ? after : before;
    stack[size++] = beyond < 0 ? before : after;
  }
  return best;
}

}  // namespace adamas
