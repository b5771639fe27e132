#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "adamas/geometry.h"
#include "core/io/mesh_file.h"

namespace adamas::io {

/// Gives points at one place, up to round-off, one number.
class PointMerger {
 public:
  /// Points of different blocks are one if they are nearer than this part of the mesh's diagonal.
  static constexpr double kCoincident = 1e-10;

  /// `tolerance`: points nearer to each other are one; it is above 0. Points are appended to `points`.
  PointMerger(double tolerance, std::vector<Vec3>& points) : cell_(4 * tolerance), points_(points) {}

  /// Returns the number of a point.
  std::uint32_t number(const Vec3& p);
  /// Returns the number of the point at a place; none where there is no point.
  [[nodiscard]] std::optional<std::uint32_t> find(const Vec3& p) const;

 private:
  [[nodiscard]] std::uint64_t key(const Vec3& p) const;

  double cell_;
  std::vector<Vec3>& points_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> places_;
};

/// The faces of cells of the common shapes, by the places of their points, which are in the order of VTK, of
/// ExodusII and, but for the wedge, of Silo.
using CellFaces = std::vector<std::vector<std::size_t>>;
extern const CellFaces kTetrahedronFaces, kPyramidFaces, kWedgeFaces, kHexahedronFaces;

/// Appends a face of the last cell, unless its points are fewer than three: edges whose ends are one point
/// vanish, and so do faces that become an edge. Throws Error if there are too many points of faces.
void append_face(std::span<const std::uint32_t> points, MeshFile& file);
/// Ends a cell, whose faces have been appended. Two faces with the same points vanish; a cell that has
/// collapsed, so that it encloses nothing, is dropped. Returns whether the cell stays.
bool end_cell(MeshFile& file);

}  // namespace adamas::io
