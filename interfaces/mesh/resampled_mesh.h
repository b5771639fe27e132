#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/fields/field_source.h"
#include "interfaces/fields/ghost_values.h"
#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/ownership/interface_table.h"

namespace adamas::interfaces {

/// A resampled mesh without its input: the leaves of the hierarchy, the distances and field values at their
/// vertices, and the measured errors. It determines the owner of each point and the values of a material's
/// fields there.
struct ResampledMesh {
  struct Cell {
    std::array<std::uint32_t, 4> vertices;  ///< positively oriented
    std::uint8_t level, phase;
    double interface_error;  ///< an estimate, in units of length
  };

  std::string source;
  Box3 box;
  IdVector<MaterialId, std::string> materials;
  InterfaceTable table;
  std::vector<FieldInfo> fields;
  std::vector<Vec3> points;
  std::vector<VertexRecord> vertices;  ///< these have no closest points
  std::vector<Cell> cells;
  /// The greatest error at a cell's native elements, by field and cell.
  std::vector<std::vector<double>> field_errors;

  /// Throws Error that names `name` and the first broken law: finite numbers, errors not below 0, lists in
  /// the order of their ids, rows if there are fields, positively oriented cells.
  void validate(const std::string& name) const;
  [[nodiscard]] CellSet cell_set() const;
  void ownership(std::size_t cell, CellOwnership& result) const;
  [[nodiscard]] std::array<Vec3, 4> corners(std::size_t cell) const;
  /// Returns the value of a component of a body's field row at a point of a cell. The body must own a part of
  /// the cell.
  [[nodiscard]] double value(std::size_t cell, BodyId body, std::size_t component,
                             const Weights& weights) const;
  /// Returns the linear interpolation of the vertices' own values, as if there were no interfaces.
  [[nodiscard]] double plain_value(std::size_t cell, std::size_t component, const Weights& weights) const;
};

/// Extracts the approximated interfaces of a mesh, with its materials and source.
ExtractedInterfaces approximated_interfaces(const ResampledMesh& mesh,
                                            Progress& progress = SilentProgress::instance());

/// Returns the rows from which fields in the cells of a mesh are interpolated, in the order of vertices, then
/// bodies: those of the bodies that own a part of a cell round the vertex, and of the vertex's own body.
std::vector<std::pair<std::uint32_t, BodyId>> needed_rows(const ResampledMesh& mesh);

}  // namespace adamas::interfaces
