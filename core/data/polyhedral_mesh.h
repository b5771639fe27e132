#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "adamas/geometry.h"

namespace adamas::inline core {

/// A mesh of polyhedra that share whole faces: the cells of a simulation. Where one cell has several smaller
/// neighbours on a side, the side is several faces, and the corners of the smaller cells are points of all
/// faces round them. Faces need not be plane: a face consists of the triangles from its centre, the mean of
/// its points, to its edges.
class PolyhedralMesh {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  using Index = std::uint32_t;

  /// Makes a mesh of cells that are given by their faces: face f of the list has the points
  /// `face_points[face_ends[f - 1] .. face_ends[f])`, in order round it, and cell c the faces
  /// `[cell_ends[c - 1] .. cell_ends[c])` of the list. Faces with the same points are one. Cells are turned
  /// the right way round. Throws Error, which begins with `name`: at a cell that is not closed or has no
  /// volume, at a face of three cells, at two cells on the same side of a face, at points that are not
  /// finite.
  static PolyhedralMesh make(const std::string& name, std::vector<Vec3> points,
                             std::vector<Index> face_points, const std::vector<Index>& face_ends,
                             const std::vector<Index>& cell_ends);

  [[nodiscard]] const std::vector<Vec3>& points() const { return points_; }
  [[nodiscard]] std::size_t cell_count() const { return cell_ends_.size(); }
  [[nodiscard]] std::size_t face_count() const { return face_ends_.size(); }
  /// The points of a face, counter-clockwise as seen from its second cell, or from outside.
  [[nodiscard]] std::span<const Index> face(std::size_t f) const { return part(face_points_, face_ends_, f); }
  /// The two cells of a face; the second one is kNone at the boundary.
  [[nodiscard]] const std::array<Index, 2>& cells_of_face(std::size_t f) const { return face_cells_[f]; }
  /// The cell beyond a face of a cell, or kNone.
  [[nodiscard]] Index neighbour(std::size_t cell, std::size_t face) const {
    const auto& [first, second] = face_cells_[face];
    return first == cell ? second : first;
  }
  [[nodiscard]] std::span<const Index> faces_of_cell(std::size_t c) const {
    return part(cell_faces_, cell_ends_, c);
  }
  [[nodiscard]] const Box3& box() const { return box_; }

  /// The mean of a face's points.
  [[nodiscard]] Vec3 face_center(std::size_t f) const;
  /// The area of a face as a vector that points out of its first cell: the sum of those of its triangles.
  [[nodiscard]] Vec3 face_area(std::size_t f) const;
  /// The mean of a cell's points, from which tetrahedra to the triangles of its faces fill it.
  [[nodiscard]] Vec3 cell_center(std::size_t c) const { return cell_centers_[c]; }
  /// The volume of a cell: the sum of those of its tetrahedra, which is exact for faces as they are defined
  /// here. It is 0 or less for a cell that is tangled or collapsed, so that volumes of regions add up.
  [[nodiscard]] double cell_volume(std::size_t c) const { return cell_volumes_[c]; }
  /// The size of a cube with the median of the cells' volumes.
  [[nodiscard]] double typical_size() const;
  /// The number of cells whose volume is not above 0.
  [[nodiscard]] std::size_t tangled_cells() const { return tangled_; }
  /// The cells round each point: those of point p are `cells_round(p)`, ascending.
  [[nodiscard]] std::span<const Index> cells_round(std::size_t point) const {
    return part(point_cells_, point_ends_, point);
  }
  /// The points of a cell, ascending.
  [[nodiscard]] std::span<const Index> points_of_cell(std::size_t c) const {
    return part(cell_points_, cell_point_ends_, c);
  }
  /// Whether the cells fill the box round them.
  [[nodiscard]] bool fills_box() const;

 private:
  static std::span<const Index> part(const std::vector<Index>& values, const std::vector<Index>& ends,
                                     std::size_t i) {
    const Index begin = i == 0 ? 0 : ends[i - 1];
    return std::span(values).subspan(begin, ends[i] - begin);
  }
  void join_faces(const std::string& name, const std::vector<Index>& points, const std::vector<Index>& ends,
                  const std::vector<Index>& cell_ends);
  void find_points_of_cells();
  void turn_outwards(const std::string& name);
  void turn_alike(const std::string& name, std::vector<signed char>& ways);
  [[nodiscard]] double volume_below(std::size_t cell, std::size_t face) const;

  std::vector<Vec3> points_;
  std::vector<Index> face_points_, face_ends_, cell_faces_, cell_ends_;
  std::vector<std::array<Index, 2>> face_cells_;
  std::vector<Index> point_cells_, point_ends_, cell_points_, cell_point_ends_;
  std::vector<Vec3> cell_centers_;
  std::vector<double> cell_volumes_;
  std::size_t tangled_ = 0;
  Box3 box_;
};

}  // namespace adamas::inline core
