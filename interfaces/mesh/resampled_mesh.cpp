#include "interfaces/mesh/resampled_mesh.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/sort_unique.h"

namespace adamas::interfaces {

namespace {

bool is_sound(const VertexRecord& vertex, std::size_t row_size) {
  const VertexDistances& known = vertex.distances;
  if (!(known.radius > 0) || !std::isfinite(known.radius)) return false;
  for (std::size_t i = 0; i < known.near.size(); ++i) {
    if (!std::isfinite(known.near[i].distance)) return false;
    if (i > 0 && !(known.near[i - 1].interface < known.near[i].interface)) return false;
  }
  if (row_size > 0 && vertex.rows.empty()) return false;
  for (std::size_t i = 0; i < vertex.rows.size(); ++i) {
    if (vertex.rows[i].row.size() != row_size) return false;
    if (i > 0 && !(vertex.rows[i - 1].body < vertex.rows[i].body)) return false;
  }
  return true;
}

bool is_error(double value) { return value >= 0 && std::isfinite(value); }

}  // namespace

void ResampledMesh::validate(const std::string& name) const {
  std::size_t row_size = 0;
  for (const FieldInfo& field : fields) row_size += static_cast<std::size_t>(field.components);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const Vec3& p = points[v];
    if (!is_finite(p))
      fail("{}: vertex {}: expected finite coordinates, found ({}, {}, {})", name, v, p.x, p.y, p.z);
    if (!is_sound(vertices[v], row_size))
      fail("{}: vertex {}: expected finite distances and rows in the order of their bodies, found others",
           name, v);
  }
  for (InterfaceId i(0); i.value < table.interface_count(); ++i.value) {
    if (table.sides(i)[0] == table.sides(i)[1])
      fail("{}: interface {}: expected two bodies, found one", name, i.value);
  }
  for (const double side : {box.size().x, box.size().y, box.size().z}) {
    if (!(side > 0) || !std::isfinite(side))
      fail("{}: expected a box with finite sides above 0, found one of {}", name, side);
  }
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!is_error(cells[c].interface_error))
      fail("{}: cell {}: expected an interface error of 0 or more, found {}", name, c,
           cells[c].interface_error);
    const auto x = corners(c);
    if (!(signed_volume(x[0], x[1], x[2], x[3]) > 0))
      fail("{}: cell {}: expected a positive volume, found {}", name, c,
           signed_volume(x[0], x[1], x[2], x[3]));
  }
  for (const auto& errors : field_errors) {
    const auto found = std::find_if_not(errors.begin(), errors.end(), is_error);
    if (found != errors.end()) fail("{}: expected errors of fields of 0 or more, found {}", name, *found);
  }
}

CellSet ResampledMesh::cell_set() const {
  CellSet set;
  set.count = cells.size();
  set.corners = [this](std::size_t i) { return cells[i].vertices; };
  set.position = [this](std::uint32_t v) { return points[v]; };
  set.distances = [this](std::uint32_t v) -> const VertexDistances& { return vertices[v].distances; };
  return set;
}

void ResampledMesh::ownership(std::size_t cell, CellOwnership& result) const {
  const auto& v = cells[cell].vertices;
  find_cell_ownership(table,
                      {&vertices[v[0]].distances, &vertices[v[1]].distances, &vertices[v[2]].distances,
                       &vertices[v[3]].distances},
                      result);
}

std::array<Vec3, 4> ResampledMesh::corners(std::size_t cell) const {
  const auto& v = cells[cell].vertices;
  return {points[v[0]], points[v[1]], points[v[2]], points[v[3]]};
}

double ResampledMesh::value(std::size_t cell, BodyId body, std::size_t component,
                            const Weights& weights) const {
  double sum = 0;
  for (std::size_t v = 0; v < 4; ++v)
    sum += weights[v] * vertices[cells[cell].vertices[v]].row(body)[component];
  return sum;
}

double ResampledMesh::plain_value(std::size_t cell, std::size_t component, const Weights& weights) const {
  double sum = 0;
  for (std::size_t v = 0; v < 4; ++v) {
    const VertexRecord& vertex = vertices[cells[cell].vertices[v]];
    sum += weights[v] * vertex.row(vertex.distances.body)[component];
  }
  return sum;
}

ExtractedInterfaces approximated_interfaces(const ResampledMesh& mesh, Progress& progress) {
  ExtractedInterfaces found = extract_interfaces(mesh.table, mesh.cell_set(), mesh.box, progress);
  found.mesh.materials = mesh.materials;
  found.mesh.source = mesh.source;
  return found;
}

std::vector<std::pair<std::uint32_t, BodyId>> needed_rows(const ResampledMesh& mesh) {
  using Need = std::pair<std::uint32_t, BodyId>;
  const auto find = [&](std::size_t first, std::size_t last, std::vector<Need>& part) {
    CellOwnership owners;
    for (std::size_t c = first; c < last; ++c) {
      mesh.ownership(c, owners);
      if (!owners.pure()) keep_owners(owners.problem);
      for (const std::uint32_t v : mesh.cells[c].vertices) {
        for (const auto& candidate : owners.problem.candidates) part.emplace_back(v, BodyId(candidate.owner));
      }
    }
    sort_unique(part);
  };
  auto needs = parallel_collect<Need>(mesh.cells.size(), 512, find);
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    needs.emplace_back(v, mesh.vertices[v].distances.body);
  sort_unique(needs);
  return needs;
}

}  // namespace adamas::interfaces
