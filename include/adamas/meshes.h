#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "adamas/export.h"
#include "adamas/geometry.h"

namespace adamas ADAMAS_API {

// This header has the meshes that calls return. Callers may read the vectors or move them away.

/// A surface of triangles with shared points and without materials, such as an exported isosurface.
struct TriangleSurface {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of points, counterclockwise from outside
  std::vector<Vec3> normals;                            ///< empty, or for each point a unit vector or zero
  std::vector<float> values;                            ///< empty, or a value for each point
  std::string value_name = "value";                     ///< the name of the values, in files that have names

  /// Throws Error with `name` where there are normals or values but not one for each point, a number is not
  /// finite, or a triangle has the index of no point.
  void check(const std::string& name) const;
};

/// Interfaces between materials: triangles on shared points, three or more of which may meet at an edge.
struct InterfaceTriangles {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of points
  /// The materials in front of each triangle, where its right-hand normal points to, and behind it.
  std::vector<std::array<std::uint32_t, 2>> sides;
  std::vector<std::string> materials;  ///< their names, by number
  /// The bodies in front of each triangle and behind it, in the order of `sides`; empty where they are not
  /// known, as of interfaces that were read from a file. A body is a connected part of a material's region.
  /// Bodies of all materials are numbered together from 0 on; one that no triangle bounds has a number too.
  /// Files do not have them, and calls that take interfaces, other than to_openmesh(), do not read them.
  std::vector<std::array<std::uint32_t, 2>> bodies{};
};

/// The topology of a body, a connected part of a material: it stays the same when the body is bent, and
/// changes only where it tears, grows a hole or merges with itself.
struct BodyTopology {
  std::size_t pieces = 0;  ///< number of connected parts of its region; 0: the body does not exist
  std::int64_t euler = 0;  ///< characteristic of its boundary inside the domain: points - edges + faces
  bool operator==(const BodyTopology&) const = default;
};

/// Tetrahedra of one material each, for solvers: neighbours share their points, and interfaces are faces.
struct MaterialTetrahedra {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;  ///< positively oriented
  std::vector<std::uint32_t> tetrahedron_materials;
  std::vector<std::string> materials;  ///< their names, by number
};

/// A cross section of data or of a mesh by a plane: convex polygons, each in one cell and of one material.
struct Slice {
  Plane plane;
  std::vector<Vec3> points;             ///< corners, counterclockwise as seen from where the normal points to
  std::vector<std::size_t> offsets{0};  ///< polygon p has the points offsets[p] to offsets[p + 1] - 1
  std::vector<std::uint32_t> polygon_materials;
  std::vector<std::size_t> polygon_cells;  ///< the number of the mesh's cell or of the grid's site
  std::string field;                       ///< name and unit of the field that `values` are of; empty: none
  /// Values of the points, linear over polygons; NaN: the material has no such field.
  std::vector<double> values;
  std::vector<std::string> materials;  ///< their names, by number
  std::vector<double> material_areas;  ///< area of each material, in the square of the unit of length
  std::vector<std::array<Vec3, 2>> cell_edges;       ///< lines between cells
  std::vector<std::array<Vec3, 2>> interface_edges;  ///< lines between materials; none for data on a grid
};

/// A view of a named array of a mesh, which owns it: `components` values for each point or cell.
struct ArrayView {
  std::string_view name;
  int components = 1;
  std::variant<std::span<const double>, std::span<const float>, std::span<const std::int32_t>,
               std::span<const std::uint8_t>, std::span<const std::string>>
      values;
};

/// A view of the arrays of a mesh of tetrahedra, which owns them.
struct TetrahedraView {
  std::span<const Vec3> points;
  std::span<const std::array<std::uint32_t, 4>> tetrahedra;  ///< positively oriented
  std::vector<ArrayView> point_arrays, cell_arrays;          ///< arrays of the points and of the tetrahedra
  std::vector<ArrayView> mesh_arrays;                        ///< arrays of the mesh as a whole
};

}  // namespace adamas
