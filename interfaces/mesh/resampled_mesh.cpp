#include "interfaces/mesh/resampled_mesh.h"

#include "interfaces/resampling/resampler.h"

namespace adamas {

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

ResampledMesh take_mesh(Resampler& resampler) {
  resampler.complete_fields();
  const auto& hierarchy = resampler.hierarchy();
  const ResamplingSource& source = resampler.source();
  ResampledMesh mesh;
  mesh.source = source.name;
  mesh.box = source.box;
  mesh.materials = source.materials;
  mesh.table = source.network->table();
  if (source.fields) mesh.fields = source.fields->fields();
  mesh.field_errors.resize(mesh.fields.size());

  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> number(hierarchy.vertex_slots(), kUnused);
  hierarchy.for_each_leaf([&](TetrahedronId t) {
    const CellRecord& record = hierarchy.payload(t);
    ResampledMesh::Cell cell{{},
                             static_cast<std::uint8_t>(hierarchy.level(t)),
                             static_cast<std::uint8_t>(hierarchy.phase(t)),
                             record.interface.distance};
    const auto vertices = hierarchy.vertices(t);
    for (std::size_t i = 0; i < 4; ++i) {
      std::uint32_t& n = number[vertices[i].value];
      if (n == kUnused) {
        n = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(hierarchy.position(vertices[i]));
        mesh.vertices.push_back(hierarchy.payload(vertices[i]));
        mesh.vertices.back().closest = {};
      }
      cell.vertices[i] = n;
    }
    mesh.cells.push_back(cell);
    for (std::size_t f = 0; f < mesh.fields.size(); ++f) mesh.field_errors[f].push_back(record.fields[f].max);
  });
  return mesh;
}

}  // namespace adamas
