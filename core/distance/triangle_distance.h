#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "adamas/geometry.h"

namespace adamas::inline core {

/// A part of a triangle. Edge i runs from corner i to corner i + 1 (mod 3).
enum class TriangleFeature : std::uint8_t { kFace, kEdge0, kEdge1, kEdge2, kVertex0, kVertex1, kVertex2 };

constexpr bool is_edge(TriangleFeature f) {
  return f >= TriangleFeature::kEdge0 && f <= TriangleFeature::kEdge2;
}
constexpr bool is_vertex(TriangleFeature f) { return f >= TriangleFeature::kVertex0; }
/// The number of the edge or of the corner.
constexpr unsigned feature_index(TriangleFeature f) {
  return static_cast<unsigned>(f) -
         static_cast<unsigned>(is_vertex(f) ? TriangleFeature::kVertex0 : TriangleFeature::kEdge0);
}
constexpr TriangleFeature edge_feature(unsigned i) {
  return static_cast<TriangleFeature>(static_cast<unsigned>(TriangleFeature::kEdge0) + i);
}
constexpr TriangleFeature vertex_feature(unsigned i) {
  return static_cast<TriangleFeature>(static_cast<unsigned>(TriangleFeature::kVertex0) + i);
}

/// Whether a triangle has so little area for its length that round-off decides its normal.
inline bool is_flat(const std::array<Vec3, 3>& corner) {
  const Vec3 ab = corner[1] - corner[0], ac = corner[2] - corner[0];
  const double spread = std::max({squared_norm(ab), squared_norm(ac), squared_norm(ac - ab)});
  return !(squared_norm(cross(ab, ac)) > 1e-16 * spread * spread);
}

/// The closest point of a triangle, and the part of the triangle that it lies on.
struct TrianglePoint {
  Vec3 point;
  double squared_distance = std::numeric_limits<double>::infinity();
  TriangleFeature feature = TriangleFeature::kFace;
};

namespace detail {

/// The closest point of the edge that starts at `corner[i]`.
inline TrianglePoint closest_on_edge(const Vec3& q, const std::array<Vec3, 3>& corner, unsigned i) {
  const Vec3& a = corner[i];
  const Vec3& b = corner[(i + 1) % 3];
  const Vec3 edge = b - a;
  const double along = dot(q - a, edge);
  const double length = squared_norm(edge);
  if (!(along > 0)) return {a, squared_norm(q - a), vertex_feature(i)};
  if (along >= length) return {b, squared_norm(q - b), vertex_feature((i + 1) % 3)};
  const Vec3 p = a + (along / length) * edge;
  return {p, squared_norm(q - p), edge_feature(i)};
}

inline TrianglePoint closest_on_edges(const Vec3& q, const std::array<Vec3, 3>& corner) {
  TrianglePoint best = closest_on_edge(q, corner, 0);
  for (unsigned i = 1; i < 3; ++i) {
    const TrianglePoint p = closest_on_edge(q, corner, i);
    if (p.squared_distance < best.squared_distance) best = p;
  }
  return best;
}

/// The closest point of a sliver: on its edges, or on its face if the projection is inside.
inline TrianglePoint closest_on_sliver(const Vec3& q, const std::array<Vec3, 3>& corner) {
  const Vec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
  TrianglePoint best = closest_on_edges(q, corner);
  const double squared = squared_norm(normal);
  if (!(squared > 0)) return best;
  const Vec3 p = q - (dot(normal, q - corner[0]) / squared) * normal;
  for (unsigned i = 0; i < 3; ++i) {
    const Vec3& a = corner[i];
    if (!(dot(cross(corner[(i + 1) % 3] - a, p - a), normal) > 0)) return best;
  }
  const double d = squared_norm(q - p);
  if (d < best.squared_distance) best = {p, d, TriangleFeature::kFace};
  return best;
}

/// The closest point of a triangle that is no sliver, by the Voronoi regions of its features (Ericson,
/// Real-Time Collision Detection, 5.1.5).
inline TrianglePoint closest_on_proper(const Vec3& q, const std::array<Vec3, 3>& corner) {
  const Vec3 ab = corner[1] - corner[0], ac = corner[2] - corner[0];
  const Vec3 ap = q - corner[0];
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {corner[0], squared_norm(ap), TriangleFeature::kVertex0};
  const Vec3 bp = q - corner[1];
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {corner[1], squared_norm(bp), TriangleFeature::kVertex1};
  const Vec3 cp = q - corner[2];
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {corner[2], squared_norm(cp), TriangleFeature::kVertex2};
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return detail::closest_on_edge(q, corner, 0);
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return detail::closest_on_edge(q, corner, 1);
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return detail::closest_on_edge(q, corner, 2);
  if (va <= 0 || vb <= 0 || vc <= 0) return detail::closest_on_edges(q, corner);
  const double scale = 1 / (va + vb + vc);
  const Vec3 p = corner[0] + (vb * scale) * ab + (vc * scale) * ac;
  return {p, squared_norm(q - p), TriangleFeature::kFace};
}

}  // namespace detail

/// Whether a triangle is so thin, or without area, that the usual weights may be made of rounding errors.
inline bool is_sliver(const std::array<Vec3, 3>& corner) {
  const Vec3 ab = corner[1] - corner[0], ac = corner[2] - corner[0];
  const double spread = std::max(squared_norm(ab), squared_norm(ac));
  return !(squared_norm(cross(ab, ac)) > 1e-6 * spread * spread);
}

/// The closest point of a triangle. A triangle without area counts as its edges.
inline TrianglePoint closest_on_triangle(const Vec3& q, const std::array<Vec3, 3>& corner) {
  return is_sliver(corner) ? detail::closest_on_sliver(q, corner) : detail::closest_on_proper(q, corner);
}

}  // namespace adamas::inline core
