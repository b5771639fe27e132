#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/data/polyhedral_mesh.h"

namespace adamas::test {

/// The points and cells of a mesh of hexahedra, which a function moves.
struct Hexahedra {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 8>> cells;  ///< in VTK's order
};

/// Makes n[0] x n[1] x n[2] hexahedra of the unit cube, with points at move(p).
inline Hexahedra make_hexahedra(const std::array<std::uint32_t, 3>& n,
                                const std::function<Vec3(const Vec3&)>& move) {
  Hexahedra result;
  const auto point = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return i + (n[0] + 1) * (j + (n[1] + 1) * k);
  };
  for (std::uint32_t k = 0; k <= n[2]; ++k) {
    for (std::uint32_t j = 0; j <= n[1]; ++j) {
      for (std::uint32_t i = 0; i <= n[0]; ++i)
        result.points.push_back(move(
            {static_cast<double>(i) / n[0], static_cast<double>(j) / n[1], static_cast<double>(k) / n[2]}));
    }
  }
  for (std::uint32_t k = 0; k < n[2]; ++k) {
    for (std::uint32_t j = 0; j < n[1]; ++j) {
      for (std::uint32_t i = 0; i < n[0]; ++i)
        result.cells.push_back({point(i, j, k), point(i + 1, j, k), point(i + 1, j + 1, k),
                                point(i, j + 1, k), point(i, j, k + 1), point(i + 1, j, k + 1),
                                point(i + 1, j + 1, k + 1), point(i, j + 1, k + 1)});
    }
  }
  return result;
}

/// Moves the inner points of the unit cube by up to `most`, in a way that depends on the place.
inline Vec3 jittered(const Vec3& p, double most) {
  Vec3 q = p;
  for (int axis = 0; axis < 3; ++axis) {
    const bool inner =
        p.x > 1e-9 && p.x < 1 - 1e-9 && p.y > 1e-9 && p.y < 1 - 1e-9 && p.z > 1e-9 && p.z < 1 - 1e-9;
    const double a = 12.9898 * p.x + 78.233 * p.y + 37.719 * p.z + 5.1 * axis;
    const double s = std::sin(a) * 43758.5453;
    if (inner) q[axis] += most * (2 * (s - std::floor(s)) - 1);
  }
  return q;
}

/// The mesh of hexahedra.
inline PolyhedralMesh to_mesh(const Hexahedra& hexahedra) {
  constexpr std::array<std::array<std::size_t, 4>, 6> kFaces{
      {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};
  std::vector<std::uint32_t> points, face_ends, cell_ends;
  for (const auto& cell : hexahedra.cells) {
    for (const auto& face : kFaces) {
      for (const std::size_t i : face) points.push_back(cell[i]);
      face_ends.push_back(static_cast<std::uint32_t>(points.size()));
    }
    cell_ends.push_back(static_cast<std::uint32_t>(face_ends.size()));
  }
  return PolyhedralMesh::make("mesh", hexahedra.points, std::move(points), face_ends, cell_ends);
}

/// The mesh of tetrahedra that has six in each hexahedron, round its diagonal.
inline PolyhedralMesh to_tetrahedra(const Hexahedra& hexahedra) {
  constexpr std::array<std::array<std::size_t, 2>, 6> kEdges{
      {{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}}};
  std::vector<std::uint32_t> points, face_ends, cell_ends;
  for (const auto& cell : hexahedra.cells) {
    for (const auto& [b, c] : kEdges) {
      const std::array<std::uint32_t, 4> corners{cell[0], cell[b], cell[c], cell[6]};
      constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
      for (const auto& face : kFaces) {
        for (const std::size_t i : face) points.push_back(corners[i]);
        face_ends.push_back(static_cast<std::uint32_t>(points.size()));
      }
      cell_ends.push_back(static_cast<std::uint32_t>(face_ends.size()));
    }
  }
  return PolyhedralMesh::make("mesh", hexahedra.points, std::move(points), face_ends, cell_ends);
}

}  // namespace adamas::test
