#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/data/polyhedral_mesh.h"

namespace adamas::interfaces {

/// The subdivision of a mesh of polyhedra into tetrahedra of a cell's centre, the centre of a face and an
/// edge of the face (docs/method.md, Any mesh). It conforms across faces. Values at cell centres determine
/// those at the other points: these are the values there of the linear functions that fit those at the
/// centres of the cells round them, by least squares, so that linear functions come back exactly.
class MeshSubdivision {
 public:
  /// Points of the subdivision: the mesh's points, then the centres of faces, then those of cells.
  using Index = std::uint32_t;

  /// The mesh must outlive this object.
  explicit MeshSubdivision(const PolyhedralMesh& mesh);

  [[nodiscard]] const PolyhedralMesh& mesh() const { return mesh_; }
  [[nodiscard]] Index point_count() const { return cell_center(static_cast<Index>(mesh_.cell_count())); }
  [[nodiscard]] Index face_center(Index face) const {
    return static_cast<Index>(mesh_.points().size()) + face;
  }
  [[nodiscard]] Index cell_center(Index cell) const {
    return face_center(static_cast<Index>(mesh_.face_count())) + cell;
  }
  [[nodiscard]] Vec3 position(Index point) const;

  /// The cells whose values determine that of a point, which is no cell's centre, and their weights.
  struct Stencil {
    std::vector<Index> cells;
    std::vector<double> weights;
  };
  /// Finds the stencil of a point. The cells are those round the point, or round the points of its face,
  /// ascending; those beside them come along where these do not extend in all directions.
  void find_stencil(Index point, Stencil& stencil) const;
  /// Finds the cells that share a point with one of these cells, ascending; these are among them.
  void find_ring(std::span<const Index> cells, std::vector<Index>& ring) const;

  /// Calls visit(corners) for the tetrahedra of a cell. They are positively oriented unless the cell is not
  /// star-shaped: its centre, the centre of a face, and the ends of an edge.
  template <class Visit>
  void for_each_tetrahedron(Index cell, Visit&& visit) const {
    for (const Index f : mesh_.faces_of_cell(cell)) {
      const std::span<const Index> points = mesh_.face(f);
      const bool outwards = mesh_.cells_of_face(f)[0] == cell;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Index a = points[i], b = points[(i + 1) % points.size()];
        visit(std::array<Index, 4>{cell_center(cell), face_center(f), outwards ? a : b, outwards ? b : a});
      }
    }
  }
  /// The volume of a tetrahedron of the subdivision.
  [[nodiscard]] double volume(const std::array<Index, 4>& corners) const {
    return signed_volume(position(corners[0]), position(corners[1]), position(corners[2]),
                         position(corners[3]));
  }

 private:
  [[nodiscard]] bool extend(std::span<const Index> cells) const;
  void set_weights(const Vec3& at, Stencil& stencil) const;

  const PolyhedralMesh& mesh_;
  std::vector<Vec3> face_centers_;
};

}  // namespace adamas::interfaces
