#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "core/data/interface_mesh.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/label_lattice.h"
#include "interfaces/reconstruction/label_runs.h"

namespace adamas::interfaces {

/// A corner of a contact polygon lies on an edge or a face of a tetrahedron of the lattice, or in the
/// tetrahedron: this is the number of its feature, which is the same in each tetrahedron that has it, and for
/// each box of cells.
using LatticeFeature = std::uint64_t;

/// A tetrahedron of a lattice cell.
struct LatticeTetrahedron {
  LabelLattice::Index cell;
  std::size_t path;
};

/// The interfaces between labels in a box of lattice cells, as triangles.
struct LabelSurfaces {
  std::vector<Vec3> points;                  ///< in the order of their first use
  std::vector<LatticeFeature> features;      ///< by point
  std::vector<InterfaceTriangle> triangles;  ///< `front` and `back` are runs
  /// The tetrahedra in which a material owns a part without a corner, or more than a convex region at its
  /// corners; the triangles leave them out. Points that tetrahedra beside them may use are among `points`.
  std::vector<LatticeTetrahedron> left_out;
};

/// Makes the interfaces in the lattice cells from `first` to before `last` along each axis. The order of
/// triangles is that of the cells, x fastest, and of the tetrahedra in each.
LabelSurfaces label_surfaces(const LabelLattice& lattice, const LabelLattice::Index& first,
                             const LabelLattice::Index& last);

/// The cells from the first to before the second, along x; none if the second is not greater.
using CellsOfRow = std::array<std::uint32_t, 2>;

/// Makes the interfaces in some lattice cells: those that `cells` returns for the rows of cells with the
/// indices j and k along y and z. A cell's triangles have the points, to the last bit, that they have among
/// those of all cells if the cells before it along each axis, and along several, are among the cells too.
LabelSurfaces label_surfaces(const LabelLattice& lattice,
                             const std::function<CellsOfRow(std::uint32_t, std::uint32_t)>& cells);

/// Returns whether a feature lies in the plane of lattice points with this index along z.
bool is_in_plane(const LabelLattice& lattice, LatticeFeature feature, std::uint32_t k);

/// Adds the features of a tetrahedron: its edges, its faces and itself.
void add_features(const LabelLattice& lattice, const LatticeTetrahedron& tetrahedron,
                  std::vector<LatticeFeature>& features);

/// Returns the feature of a contact polygon's corner in a tetrahedron whose corners have these owners, and
/// true if each of the functions that are equal at the corner belongs to the owner of one of the feature's
/// corners; else false.
std::pair<LatticeFeature, bool> feature_of(const LabelLattice& lattice, const LatticeTetrahedron& tetrahedron,
                                           const std::array<std::uint16_t, 4>& owners,
                                           const ContactPolygon::Corner& corner);

}  // namespace adamas::interfaces
