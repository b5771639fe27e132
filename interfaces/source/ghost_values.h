#pragma once

#include <span>
#include <vector>

#include "adamas/resample.h"  // GhostMode
#include "interfaces/ownership/cell_ownership.h"
#include "interfaces/source/resampling_source.h"

namespace adamas::interfaces {

/// What the resampled mesh knows at one vertex.
struct VertexRecord {
  VertexDistances distances;
  std::vector<Vec3> closest;  ///< the closest points that belong to `distances.near`
  /// Fields of the bodies that the cells round the vertex need, by body.
  struct BodyRow {
    BodyId body;
    std::vector<double> row;
  };
  std::vector<BodyRow> rows;

  /// Whether there is a row of the body's own.
  [[nodiscard]] bool knows(BodyId body) const;
  /// The row of a body; of the next one by number, or the last, where the body owns no part of any cell round
  /// the vertex.
  [[nodiscard]] std::span<const double> row(BodyId body) const;
};

/// Values of a body's fields at a vertex: the input's where the vertex lies in the body, ghost values
/// elsewhere. One row per vertex and body, the same for all cells round the vertex.
std::vector<double> fields_at_vertex(const ResamplingSource& source, GhostMode mode, const Vec3& position,
                                     const VertexRecord& vertex, BodyId body);

}  // namespace adamas::interfaces
