#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "adamas/geometry.h"

namespace adamas::inline core {

/// The six edges of a tetrahedron, as pairs of its vertices.
inline constexpr std::array<std::array<std::uint8_t, 2>, 6> kTetrahedronEdges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// The contour of a linear function over a tetrahedron: none, one or two triangles whose corners lie on edges
/// of the tetrahedron, by index into kTetrahedronEdges. Where the tetrahedron is positively oriented, normals
/// point to the vertices below.
struct TetrahedronContour {
  std::uint8_t triangle_count = 0;
  std::array<std::array<std::uint8_t, 3>, 2> triangles{};
};

namespace tetrahedron_contour_detail {

/// Twice the vertices of a positively oriented tetrahedron, so that midpoints of edges are whole numbers.
inline constexpr std::array<Vec3, 4> kVertices{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}}};

constexpr Vec3 midpoint(std::uint8_t edge) {
  return 0.5 * (kVertices[kTetrahedronEdges[edge][0]] + kVertices[kTetrahedronEdges[edge][1]]);
}

constexpr bool share_vertex(std::uint8_t e, std::uint8_t f) {
  const auto &a = kTetrahedronEdges[e], &b = kTetrahedronEdges[f];
  return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
}

/// A vector that points from the vertices above to those below.
constexpr Vec3 descent(unsigned above) {
  Vec3 sum_above, sum_below;
  int count = 0;
  for (unsigned v = 0; v < 4; ++v) {
    const bool is_above = (above >> v & 1) != 0;
    (is_above ? sum_above : sum_below) += kVertices[v];
    count += is_above ? 1 : 0;
  }
  return count * sum_below - (4 - count) * sum_above;
}

constexpr std::array<std::uint8_t, 3> oriented(std::array<std::uint8_t, 3> triangle, unsigned above) {
  const Vec3 a = midpoint(triangle[0]), b = midpoint(triangle[1]), c = midpoint(triangle[2]);
  if (dot(cross(b - a, c - a), descent(above)) < 0) std::swap(triangle[1], triangle[2]);
  return triangle;
}

constexpr TetrahedronContour contour(unsigned above) {
  std::array<std::uint8_t, 4> cut{};
  std::size_t count = 0;
  for (std::uint8_t e = 0; e < 6; ++e) {
    const auto [v, w] = kTetrahedronEdges[e];
    if ((above >> v & 1) != (above >> w & 1)) cut[count++] = e;
  }
  TetrahedronContour result;
  if (count == 3) {
    result.triangle_count = 1;
    result.triangles[0] = oriented({cut[0], cut[1], cut[2]}, above);
  } else if (count == 4) {
    // The first edge and the one without a common vertex lie across the quadrilateral: they give the
    // diagonal.
    std::size_t across = 1;
    while (share_vertex(cut[0], cut[across])) ++across;
    std::swap(cut[2], cut[across]);
    result.triangle_count = 2;
    result.triangles[0] = oriented({cut[0], cut[1], cut[2]}, above);
    result.triangles[1] = oriented({cut[0], cut[2], cut[3]}, above);
  }
  return result;
}

constexpr std::array<TetrahedronContour, 16> all_contours() {
  std::array<TetrahedronContour, 16> contours{};
  for (unsigned above = 0; above < 16; ++above) contours[above] = contour(above);
  return contours;
}

}  // namespace tetrahedron_contour_detail

/// The contours by the set of vertices above, with bit v for vertex v. The compiler computes them from the
/// geometry.
inline constexpr std::array<TetrahedronContour, 16> kTetrahedronContours =
    tetrahedron_contour_detail::all_contours();

}  // namespace adamas::inline core
