#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/typed_id.h"
#include "core/data/multi_material_data.h"
#include "core/geometry/plane.h"
#include "interfaces/cross_section/field_choice.h"
#include "interfaces/cross_section/section_edges.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

/// A convex part of a cross section that lies in one cell and one body.
struct SectionPiece {
  std::vector<Vec3> corners;  ///< counter-clockwise seen from where the plane's normal points to
  BodyId body;                ///< invalid in sections of data on a grid, which know no bodies
  MaterialId material;
  /// Of the chosen field, one per corner, linear over the piece (the length of a vector: linear between the
  /// corners); NaN where the material has no such field. Empty without a choice.
  std::vector<double> values;
  std::size_t cell = 0;  ///< of the mesh, or the site of the grid
};

/// What a plane cuts out of a domain (D 3.7).
struct CrossSection {
  std::vector<SectionPiece> pieces;
  std::vector<Segment> cell_edges;       ///< each once
  std::vector<Segment> interface_edges;  ///< between bodies, each once
  IdVector<MaterialId, double> material_area;
  double area = 0;  ///< of all materials
};

/// Which values the pieces get.
enum class SectionMode {
  kPerMaterial,  ///< each material's own field up to its interfaces (D figure 3.8)
  kPlain,        ///< plain linear interpolation in the cells, whatever the interfaces (D figure 3.7, right)
};

/// The section of a resampled mesh. The pieces fill the plane's part of the box once, also where the plane
/// runs through vertices, edges and faces of the mesh; in a plane that coincides with faces the cells below
/// count (above, on the box's lowest side). The same in any number of threads. Throws Error as PlaneSides
/// does, and where the chosen field does not exist.
CrossSection cross_section(const ResampledMesh& mesh, const Plane& plane,
                           const std::optional<FieldChoice>& field,
                           SectionMode mode = SectionMode::kPerMaterial);

/// The section of data on a grid, as they are. Each site is a piece or more: of cell data its cell with one
/// value; of point data what is nearest to the point along each axis, with the values of trilinear
/// interpolation at the corners for mixed fields and one value for fields per material. A piece shows the
/// material with the greatest fraction, the first of equal ones, and that material's value; `material_area`
/// weights areas by the fractions. `cell_edges` are those of the sites' cells; there are no interface edges.
CrossSection cross_section(const MultiMaterialData& data, const Plane& plane,
                           const std::optional<FieldChoice>& field);

/// The section of given interfaces in a box, as trapezoids and triangles between the lines in which the plane
/// cuts them, by exact predicates (trapezoidal_decomposition); without cells and interface edges. Where
/// interfaces end in the box, bodies go on as if they went on straight. `source`: for messages. Throws Error
/// as PlaneSides does.
CrossSection cross_section(const InterfaceNetwork& network, const Box3& box, std::size_t materials,
                           const Plane& plane, const std::string& source);

}  // namespace adamas::interfaces
