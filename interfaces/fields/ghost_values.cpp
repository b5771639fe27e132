#include "interfaces/fields/ghost_values.h"

#include <algorithm>
#include <limits>

#include "core/base/assert.h"

namespace adamas::interfaces {

namespace {

/// Returns the closest point on a body's interfaces.
Vec3 closest_on_body(const InterfaceNetwork& network, const Vec3& position, const VertexRecord& vertex,
                     BodyId body) {
  Vec3 best = position;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < vertex.closest.size(); ++i) {
    const auto& [a, b] = network.table().sides(vertex.distances.near[i].interface);
    if (a != body && b != body) continue;
    const double d = squared_norm(vertex.closest[i] - position);
    if (d < least) least = d, best = vertex.closest[i];
  }
  if (least < std::numeric_limits<double>::infinity()) return best;
  const auto closest = network.tree(body).closest(position);
  return closest ? closest->point : position;
}

}  // namespace

const std::vector<double>* VertexRecord::find(BodyId body) const {
  const auto found = std::ranges::lower_bound(rows, body, {}, &BodyRow::body);
  return found == rows.end() || found->body != body ? nullptr : &found->row;
}

std::vector<double>& VertexRecord::add_row(BodyId body) {
  const auto found = std::ranges::lower_bound(rows, body, {}, &BodyRow::body);
  return found != rows.end() && found->body == body ? found->row : rows.insert(found, BodyRow{body, {}})->row;
}

std::span<const double> VertexRecord::row(BodyId body) const {
  ADAMAS_ASSERT(!rows.empty());
  const auto found = std::ranges::lower_bound(rows, body, {}, &BodyRow::body);
  return found == rows.end() ? rows.back().row : found->row;
}

std::vector<double> fields_at_vertex(const FieldSource& fields, const InterfaceNetwork& network,
                                     GhostMode mode, const Vec3& position, const VertexRecord& vertex,
                                     BodyId body) {
  std::vector<double> row(fields.row_size());
  const MaterialId material = network.table().material(body);
  if (vertex.distances.body == body) {
    fields.values(material, position, row);
    return row;
  }
  const Vec3 closest = closest_on_body(network, position, vertex, body);
  if (mode == GhostMode::kConstant) {
    fields.values(material, closest, row);
    return row;
  }
  if (mode == GhostMode::kLeastSquares) {
    fields.fitted_values(material, position, closest, row);
    return row;
  }
  std::vector<Vec3> gradients(row.size());
  fields.values_and_gradients(material, closest, row, gradients);
  for (std::size_t c = 0; c < row.size(); ++c) row[c] += dot(gradients[c], position - closest);
  return row;
}

}  // namespace adamas::interfaces
