#include "interfaces/mesh/resampled_mesh_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "interfaces/mesh/mesh_arrays.h"

namespace adamas::interfaces {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::int32_t kVersion = 1;
using Integers = std::vector<std::int32_t>;
using Doubles = std::vector<double>;

std::int32_t integer(std::uint32_t value) { return static_cast<std::int32_t>(value); }

/// Returns the row of the vertex's own body or of any other body of the material; null if there is none.
const std::vector<double>* material_row(const ResampledMesh& mesh, const VertexRecord& vertex,
                                        MaterialId material) {
  const std::vector<double>* found = nullptr;
  for (const auto& row : vertex.rows) {
    if (mesh.table.material(row.body) != material) continue;
    if (row.body == vertex.distances.body) return &row.row;
    if (found == nullptr) found = &row.row;
  }
  return found;
}

void add_vertex_arrays(const ResampledMesh& mesh, UnstructuredMesh& file) {
  Integers material, body;
  for (const VertexRecord& vertex : mesh.vertices) {
    body.push_back(integer(vertex.distances.body.value));
    material.push_back(integer(mesh.table.material(vertex.distances.body).value));
  }
  file.point_arrays.push_back({"material", 1, std::move(material)});
  file.point_arrays.push_back({"body", 1, std::move(body)});
  for (const FieldInfo& field : mesh.fields) {
    const auto components = static_cast<std::size_t>(field.components);
    const auto collect = [&](auto&& row_of, const std::string& name) {
      Doubles values;
      bool any = false;
      for (const VertexRecord& vertex : mesh.vertices) {
        const std::vector<double>* row = row_of(vertex);
        for (std::size_t c = 0; c < components; ++c) {
          values.push_back(row == nullptr ? kNothing : (*row)[field.offset + c]);
          any = any || !std::isnan(values.back());
        }
      }
      if (any) file.point_arrays.push_back({name, field.components, std::move(values)});
      return any;
    };
    collect(
        [&](const VertexRecord& v) { return material_row(mesh, v, mesh.table.material(v.distances.body)); },
        field.name);
    for (MaterialId m(0); m.value < mesh.materials.size(); ++m.value) {
      const std::string name = field.name + " in " + mesh.materials[m];
      if (!collect([&](const VertexRecord& v) { return material_row(mesh, v, m); }, name)) continue;
      std::vector<std::uint8_t> valid;
      for (const VertexRecord& v : mesh.vertices)
        valid.push_back(mesh.table.material(v.distances.body) == m ? 1 : 0);
      file.point_arrays.push_back({name + " validity", 1, std::move(valid)});
    }
  }
}

/// Returns the material of a cell that lies in one body; of others -1.
std::int32_t sole_material(const ResampledMesh& mesh, std::size_t cell, CellOwnership& ownership) {
  mesh.ownership(cell, ownership);
  OwnershipProblem& problem = ownership.problem;
  if (!ownership.pure()) {
    // With many bodies, the owners of vertices are found sooner than all owners.
    for (std::size_t v = 1; v < 4; ++v) {
      if (problem.owner(kVertexWeights[v]) != problem.owner(kVertexWeights[0])) return -1;
    }
    keep_owners(problem);
  }
  if (!ownership.pure()) return -1;
  return integer(mesh.table.material(BodyId(problem.candidates[0].owner)).value);
}

void add_cell_arrays(const ResampledMesh& mesh, UnstructuredMesh& file) {
  Integers material(mesh.cells.size()), level, phase;
  parallel_chunks(mesh.cells.size(), 256, [&](std::size_t first, std::size_t last) {
    CellOwnership ownership;
    for (std::size_t c = first; c < last; ++c) material[c] = sole_material(mesh, c, ownership);
  });
  Doubles error;
  for (const ResampledMesh::Cell& cell : mesh.cells) {
    level.push_back(cell.level);
    phase.push_back(cell.phase);
    error.push_back(cell.interface_error);
  }
  file.cell_arrays.push_back({"material", 1, std::move(material)});
  file.cell_arrays.push_back({"level", 1, std::move(level)});
  file.cell_arrays.push_back({"phase", 1, std::move(phase)});
  file.cell_arrays.push_back({"interface error", 1, std::move(error)});
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    file.cell_arrays.push_back({mesh.fields[f].name + " error", 1, mesh.field_errors[f]});
  }
}

}  // namespace

UnstructuredMesh to_unstructured_mesh(const ResampledMesh& mesh) {
  UnstructuredMesh file;
  file.points = mesh.points;
  for (const auto& cell : mesh.cells) {
    file.connectivity.insert(file.connectivity.end(), cell.vertices.begin(), cell.vertices.end());
    file.offsets.push_back(file.connectivity.size());
  }
  add_vertex_arrays(mesh, file);
  add_cell_arrays(mesh, file);
  file.field_arrays.push_back({kResampledVersion, 1, Integers{kVersion}});
  add_knowledge(mesh, "adamas ", file.field_arrays);
  return file;
}

bool is_resampled_mesh(const UnstructuredMesh& mesh) {
  return mesh.kind == CellKind::kTetrahedra &&
         std::any_of(mesh.field_arrays.begin(), mesh.field_arrays.end(),
                     [](const NamedArray& array) { return array.name == kResampledVersion; });
}

ResampledMesh from_unstructured_mesh(const UnstructuredMesh& file, const std::string& source) {
  const ArrayReader arrays(file.field_arrays, "adamas ", source), cells(file.cell_arrays, "", source),
      points(file.point_arrays, "", source);
  if (!is_resampled_mesh(file)) fail("{}: expected a mesh written by adamas resample, found another", source);
  if (const auto& version = arrays.get<Integers>("version", 1); version[0] != kVersion) {
    fail("{}: expected version {} of a resampled mesh, found {}", source, kVersion, version[0]);
  }
  ResampledMesh mesh;
  mesh.source = source;
  mesh.points = file.points;
  read_knowledge(arrays, points.get<Integers>("body", mesh.points.size()), mesh);

  const std::size_t count = file.cell_count();
  const auto& level = cells.get<Integers>("level", count);
  const auto& phase = cells.get<Integers>("phase", count);
  const auto& error = cells.get<Doubles>("interface error", count);
  for (std::size_t c = 0; c < count; ++c) {
    if (file.offsets[c + 1] - file.offsets[c] != 4)
      fail("{}: expected tetrahedra, found a cell of {} points", source,
           file.offsets[c + 1] - file.offsets[c]);
    const auto first = file.connectivity.begin() + static_cast<std::ptrdiff_t>(file.offsets[c]);
    ResampledMesh::Cell cell{{},
                             static_cast<std::uint8_t>(cells.index(level[c], 64, "level")),
                             static_cast<std::uint8_t>(cells.index(phase[c], 3, "phase")),
                             error[c]};
    std::copy(first, first + 4, cell.vertices.begin());
    for (const std::uint32_t v : cell.vertices) {
      if (v >= mesh.points.size())
        fail("{}: expected point indices below {}, found {}", source, mesh.points.size(), v);
    }
    mesh.cells.push_back(cell);
  }
  for (const FieldInfo& field : mesh.fields)
    mesh.field_errors.push_back(cells.get<Doubles>(field.name + " error", count));
  mesh.validate(source);
  return mesh;
}

}  // namespace adamas::interfaces
