#pragma once

#include <array>
#include <functional>
#include <vector>

#include "adamas/progress.h"
#include "interfaces/cell_errors/field_error.h"
#include "interfaces/comparison/mesh_figures.h"
#include "interfaces/mesh/conforming_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::interfaces {

/// The cells of any mesh, in the form in which field errors are measured.
struct MeasuredCells {
  std::size_t count = 0;
  std::function<std::array<Vec3, 4>(std::size_t)> corners;
  std::function<CellView(std::size_t)> view;  ///< returns a cell with parts; several threads may call it at
                                              ///< once
};

/// Returns the cells of a resampled mesh, which must outlive them.
MeasuredCells measured_cells(const ResampledMesh& mesh);
/// Returns the cells of a conforming mesh with fields at its vertices; both must outlive them.
MeasuredCells measured_cells(const ConformingMesh& mesh, const std::vector<VertexRecord>& vertices);

/// Returns the fields of the source at the vertices of a mesh, for each body that has a tetrahedron there.
std::vector<VertexRecord> fields_at_vertices(const ConformingMesh& mesh, const ResamplingSource& source);

/// The errors of a mesh's fields at each native element of the source, measured as the resampler does
/// (docs/method.md, Errors); displaced elements have the least error in the whole box with the given
/// half-width.
struct ElementErrors {
  std::size_t fields = 0;
  std::vector<FieldError> errors;    ///< errors[element * fields + field]
  std::vector<std::uint32_t> cells;  ///< the cell that holds each element

  /// Returns the figures over all elements and over those marked by `at_interface`.
  [[nodiscard]] std::vector<FieldFigures> figures(const std::vector<char>& at_interface) const;
};
ElementErrors measure_element_errors(const ResamplingSource& source, const MeasuredCells& cells,
                                     double half_width,
                                     const Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
