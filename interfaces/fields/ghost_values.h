#pragma once

#include <span>
#include <vector>

#include "adamas/resample.h"  // GhostMode
#include "interfaces/fields/field_source.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/ownership/cell_ownership.h"

namespace adamas::interfaces {

/// The distances and field values of a resampled mesh at one vertex.
struct VertexRecord {
  VertexDistances distances;
  std::vector<Vec3> closest;  ///< the closest points, in the order of `distances.near`
  /// The field values of a body; rows exist for bodies that the cells round the vertex need, in the order of
  /// the bodies.
  struct BodyRow {
    BodyId body;
    std::vector<double> row;
  };
  std::vector<BodyRow> rows;

  /// Returns the row of a body; null if there is none.
  [[nodiscard]] const std::vector<double>* find(BodyId body) const;
  /// Returns the row of a body, which is added empty if there is none.
  std::vector<double>& add_row(BodyId body);
  /// Returns the row of a body. If the body owns no part of any cell round the vertex, the row is that of the
  /// next body with a row, or of the last one.
  [[nodiscard]] std::span<const double> row(BodyId body) const;
};

/// Returns the values of a body's fields at a vertex: those of the input where the vertex lies in the body,
/// else ghost values. They are the same for all cells round the vertex.
std::vector<double> fields_at_vertex(const FieldSource& fields, const InterfaceNetwork& network,
                                     GhostMode mode, const Vec3& position, const VertexRecord& vertex,
                                     BodyId body);

}  // namespace adamas::interfaces
