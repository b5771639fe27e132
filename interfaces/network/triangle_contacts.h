#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "adamas/geometry.h"
#include "core/data/interface_mesh.h"

namespace adamas::interfaces {

/// A triangle: the numbers of its points, and their positions.
struct PlacedTriangle {
  std::array<std::uint32_t, 3> points;
  std::array<Vec3, 3> corners;
};

/// Returns, exactly, whether two triangles have a point in common that is not on a corner or an edge of both.
/// Triangles without area touch nothing.
bool in_contact(const PlacedTriangle& a, const PlacedTriangle& b);

/// Returns, exactly, whether a tetrahedron holds a point, inside or on its boundary. A tetrahedron without
/// volume holds none.
bool tetrahedron_contains(const std::array<Vec3, 4>& tetrahedron, const Vec3& p);

/// The pairs of triangles that intersect without a common corner. Degenerate triangles are left out.
struct SelfIntersections {
  std::size_t count = 0;
  std::optional<std::array<std::uint32_t, 2>> first;  ///< the lowest pair
};
/// Finds self-intersections exactly. Points must be finite and indices within range.
SelfIntersections find_self_intersections(const InterfaceMesh& mesh);

/// Returns the pairs of triangles of a welded mesh that are in contact, the lower one first, in ascending
/// order. Points must be finite and indices within range.
std::vector<std::array<std::uint32_t, 2>> find_contacts(const InterfaceMesh& mesh);

}  // namespace adamas::interfaces
