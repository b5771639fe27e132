#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/typed_id.h"
#include "core/data/interface_mesh.h"
#include "core/data/mesh_data.h"
#include "core/data/multi_material_data.h"
#include "core/geometry/plane.h"
#include "core/geometry/plane_sides.h"
#include "interfaces/cross_section/field_choice.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

/// A line between two points.
using Segment = std::array<Vec3, 2>;

/// A convex part of a cross section that lies in one cell and one body.
struct SectionPiece {
  std::vector<Vec3> corners;  ///< counter-clockwise as seen from the side to which the plane's normal points
  BodyId body;                ///< invalid in sections of data on a grid, which have no bodies
  MaterialId material;
  /// The values of the chosen field, one per corner, between which it is linear; NaN if the material has no
  /// such field. Empty if no field is chosen.
  std::vector<double> values;
  std::size_t cell = 0;  ///< the cell of the mesh, or the site of the grid
};

/// The cross section of a domain and a plane (D 3.7).
struct CrossSection {
  std::vector<SectionPiece> pieces;
  std::vector<Segment> cell_edges;       ///< each once
  std::vector<Segment> interface_edges;  ///< edges between bodies, each once
  IdVector<MaterialId, double> material_area;
  double area = 0;  ///< the area of all materials
};

/// The kind of values that the pieces get.
enum class SectionMode {
  kPerMaterial,  ///< each material's own field up to its interfaces (D figure 3.8)
  kPlain,        ///< linear interpolation in the cells that ignores interfaces (D figure 3.7, right)
};

/// Cuts a resampled mesh by a plane. The pieces fill the plane's part of the box once, also where the plane
/// runs through vertices, edges and faces of the mesh; if the plane coincides with faces, the cells below it
/// count (above it, on the box's lowest side). The result does not depend on the number of threads. Throws
/// Error as PlaneSides does, and if the chosen field does not exist.
CrossSection cross_section(const ResampledMesh& mesh, const Plane& plane,
                           const std::optional<FieldChoice>& field,
                           SectionMode mode = SectionMode::kPerMaterial);

/// Cuts data on a grid by a plane. Each site gives one piece or more: for cell data its cell, with one value;
/// for point data the box that is nearest to the point along each axis, with values by trilinear
/// interpolation at the corners for mixed fields, and one value for fields per material. A piece shows the
/// material with the greatest fraction, the first of equal ones, and that material's value; `material_area`
/// weights areas by the fractions. `cell_edges` are those of the sites' cells, unless they are not asked for;
/// there are no interface edges.
CrossSection cross_section(const MultiMaterialData& data, const Plane& plane,
                           const std::optional<FieldChoice>& field, bool cell_edges = true);

/// Cuts data on a mesh of cells by a plane: a piece, which need not be convex, for each cell that it cuts,
/// with the values of the cell or, for fields on points, linear ones along its edges. Materials are shown as
/// above; cells that do not fill the box leave the rest empty.
CrossSection cross_section(const MeshData& data, const Plane& plane, const std::optional<FieldChoice>& field,
                           bool cell_edges = true);

/// Returns the edges of pieces, each once, without those between two pieces of one cell.
std::vector<Segment> piece_edges(const std::vector<SectionPiece>& pieces);

/// Cuts given interfaces in a box by a plane. The pieces are trapezoids and triangles between the lines in
/// which the plane cuts the interfaces, found by exact predicates (trapezoidal_decomposition()); there are no
/// cells and no interface edges. Interfaces that end in the box are continued straight. `source`: the name
/// for messages. Throws Error as PlaneSides does.
CrossSection cross_section(const InterfaceNetwork& network, const Box3& box, std::size_t materials,
                           const Plane& plane, const std::string& source);

/// Returns the lines in which a plane cuts the triangles of interfaces, each once (the original interfaces of
/// D figure 3.7). `box`: the domain that decides ties and that the plane must cut; throws Error as PlaneSides
/// does.
std::vector<Segment> section_edges(const InterfaceMesh& mesh, const Plane& plane, const Box3& box);

}  // namespace adamas::interfaces
