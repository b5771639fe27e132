#include "interfaces/mesh/resampled_mesh_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace adamas {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::int32_t kVersion = 1;
using Integers = std::vector<std::int32_t>;
using Doubles = std::vector<double>;
using Strings = std::vector<std::string>;

std::int32_t integer(std::uint32_t value) { return static_cast<std::int32_t>(value); }

/// The row of the vertex's own body, or of any other body of the material; null where there is none.
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

void add_cell_arrays(const ResampledMesh& mesh, UnstructuredMesh& file) {
  Integers material, level, phase;
  Doubles error;
  CellOwnership ownership;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    mesh.ownership(c, ownership);
    if (!ownership.pure()) keep_owners(ownership.problem);
    const BodyId body(ownership.problem.candidates[0].owner);
    material.push_back(ownership.pure() ? integer(mesh.table.material(body).value) : -1);
    level.push_back(mesh.cells[c].level);
    phase.push_back(mesh.cells[c].phase);
    error.push_back(mesh.cells[c].interface_error);
  }
  file.cell_arrays.push_back({"material", 1, std::move(material)});
  file.cell_arrays.push_back({"level", 1, std::move(level)});
  file.cell_arrays.push_back({"phase", 1, std::move(phase)});
  file.cell_arrays.push_back({"interface error", 1, std::move(error)});
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    file.cell_arrays.push_back({mesh.fields[f].name + " error", 1, mesh.field_errors[f]});
  }
}

void add_field_arrays(const ResampledMesh& mesh, UnstructuredMesh& file) {
  const auto add = [&](const std::string& name, auto values, int components = 1) {
    file.field_arrays.push_back({"adamas " + name, components, std::move(values)});
  };
  add("version", Integers{kVersion});
  add("source", Strings{mesh.source});
  add("box",
      Doubles{mesh.box.min.x, mesh.box.min.y, mesh.box.min.z, mesh.box.max.x, mesh.box.max.y, mesh.box.max.z},
      3);
  add("materials", Strings(mesh.materials.begin(), mesh.materials.end()));
  Integers bodies, interfaces;
  for (BodyId b(0); b.value < mesh.table.body_count(); ++b.value)
    bodies.push_back(integer(mesh.table.material(b).value));
  for (InterfaceId i(0); i.value < mesh.table.interface_count(); ++i.value) {
    for (const BodyId side : mesh.table.sides(i)) interfaces.push_back(integer(side.value));
  }
  add("body materials", std::move(bodies));
  add("interface bodies", std::move(interfaces), 2);
  Strings names, units;
  Integers components;
  Doubles ranges;
  for (const FieldInfo& field : mesh.fields) {
    names.push_back(field.name);
    units.push_back(field.unit);
    components.push_back(field.components);
    ranges.insert(ranges.end(), {field.min, field.max});
  }
  add("fields", std::move(names));
  add("field units", std::move(units));
  add("field components", std::move(components));
  add("field ranges", std::move(ranges), 2);

  Doubles radius, distances, rows;
  std::vector<std::uint8_t> flagged;
  Integers near_counts, near_interfaces, row_counts, row_bodies;
  for (const VertexRecord& vertex : mesh.vertices) {
    radius.push_back(vertex.distances.radius);
    flagged.push_back(vertex.distances.flagged ? 1 : 0);
    near_counts.push_back(static_cast<std::int32_t>(vertex.distances.near.size()));
    for (const NearDistance& near : vertex.distances.near) {
      near_interfaces.push_back(integer(near.interface.value));
      distances.push_back(near.distance);
    }
    row_counts.push_back(static_cast<std::int32_t>(vertex.rows.size()));
    for (const auto& row : vertex.rows) {
      row_bodies.push_back(integer(row.body.value));
      rows.insert(rows.end(), row.row.begin(), row.row.end());
    }
  }
  add("vertex radius", std::move(radius));
  add("vertex flagged", std::move(flagged));
  add("vertex interface counts", std::move(near_counts));
  add("vertex interfaces", std::move(near_interfaces));
  add("vertex signed distances", std::move(distances));
  add("vertex row counts", std::move(row_counts));
  add("vertex row bodies", std::move(row_bodies));
  add("vertex rows", std::move(rows));
}

/// Finds arrays by name and type and checks their lengths.
class Arrays {
 public:
  Arrays(const std::vector<NamedArray>& arrays, std::string prefix, const std::string& source)
      : arrays_(arrays), prefix_(std::move(prefix)), source_(source) {}

  template <class Values>
  const Values& get(const std::string& name) const {
    for (const NamedArray& array : arrays_) {
      if (array.name != prefix_ + name) continue;
      if (const auto* values = std::get_if<Values>(&array.values)) return *values;
      fail("{}: array '{}{}': expected another type of values", source_, prefix_, name);
    }
    // Writers leave out arrays without values.
    static const Values kNone;
    return kNone;
  }
  template <class Values>
  const Values& get(const std::string& name, std::size_t length) const {
    const Values& values = get<Values>(name);
    if (values.size() != length) {
      fail("{}: array '{}{}': expected {} values, found {}", source_, prefix_, name, length, values.size());
    }
    return values;
  }
  [[nodiscard]] std::uint32_t index(std::int32_t value, std::size_t end, const std::string& name) const {
    if (value < 0 || static_cast<std::size_t>(value) >= end) {
      fail("{}: array '{}{}': expected indices below {}, found {}", source_, prefix_, name, end, value);
    }
    return static_cast<std::uint32_t>(value);
  }
  [[nodiscard]] std::size_t total(const Integers& counts, const std::string& name) const {
    std::size_t sum = 0;
    for (const std::int32_t count : counts)
      sum += index(count, std::numeric_limits<std::int32_t>::max(), name);
    return sum;
  }

 private:
  const std::vector<NamedArray>& arrays_;
  std::string prefix_;
  const std::string& source_;
};

void read_table(const Arrays& arrays, ResampledMesh& mesh) {
  const auto& names = arrays.get<Strings>("materials");
  mesh.materials.assign(names.begin(), names.end());
  IdVector<BodyId, MaterialId> materials;
  for (const std::int32_t m : arrays.get<Integers>("body materials")) {
    materials.emplace_back(arrays.index(m, names.size(), "body materials"));
  }
  IdVector<InterfaceId, std::array<BodyId, 2>> sides;
  const auto& pairs = arrays.get<Integers>("interface bodies");
  if (pairs.size() % 2 != 0) arrays.get<Integers>("interface bodies", pairs.size() + 1);
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2) {
    sides.push_back({BodyId(arrays.index(pairs[i], materials.size(), "interface bodies")),
                     BodyId(arrays.index(pairs[i + 1], materials.size(), "interface bodies"))});
  }
  mesh.table = InterfaceTable(std::move(materials), std::move(sides));
}

std::size_t read_fields(const Arrays& arrays, ResampledMesh& mesh) {
  const auto& names = arrays.get<Strings>("fields");
  const auto& units = arrays.get<Strings>("field units", names.size());
  const auto& components = arrays.get<Integers>("field components", names.size());
  const auto& ranges = arrays.get<Doubles>("field ranges", 2 * names.size());
  std::size_t offset = 0;
  for (std::size_t f = 0; f < names.size(); ++f) {
    const auto count = static_cast<int>(arrays.index(components[f], 1000, "field components"));
    mesh.fields.push_back({names[f], units[f], count, offset, ranges[2 * f], ranges[2 * f + 1]});
    offset += static_cast<std::size_t>(count);
  }
  return offset;
}

void read_vertices(const Arrays& arrays, const Integers& bodies, std::size_t row_size, ResampledMesh& mesh) {
  const std::size_t count = mesh.points.size();
  const auto& radius = arrays.get<Doubles>("vertex radius", count);
  const auto& flagged = arrays.get<std::vector<std::uint8_t>>("vertex flagged", count);
  const auto& near_counts = arrays.get<Integers>("vertex interface counts", count);
  const auto& row_counts = arrays.get<Integers>("vertex row counts", count);
  const std::size_t near_total = arrays.total(near_counts, "vertex interface counts");
  const std::size_t row_total = arrays.total(row_counts, "vertex row counts");
  const auto& interfaces = arrays.get<Integers>("vertex interfaces", near_total);
  const auto& distances = arrays.get<Doubles>("vertex signed distances", near_total);
  const auto& row_bodies = arrays.get<Integers>("vertex row bodies", row_total);
  const auto& rows = arrays.get<Doubles>("vertex rows", row_total * row_size);
  mesh.vertices.resize(count);
  for (std::size_t v = 0, near = 0, row = 0; v < count; ++v) {
    VertexDistances& known = mesh.vertices[v].distances;
    known.body = BodyId(arrays.index(bodies[v], mesh.table.body_count(), "body"));
    known.radius = radius[v];
    known.flagged = flagged[v] != 0;
    for (std::int32_t i = 0; i < near_counts[v]; ++i, ++near) {
      known.near.push_back(
          {InterfaceId(arrays.index(interfaces[near], mesh.table.interface_count(), "vertex interfaces")),
           distances[near]});
    }
    list_known_bodies(mesh.table, known);
    for (std::int32_t i = 0; i < row_counts[v]; ++i, ++row) {
      const auto first = rows.begin() + static_cast<std::ptrdiff_t>(row * row_size);
      mesh.vertices[v].rows.push_back(
          {BodyId(arrays.index(row_bodies[row], mesh.table.body_count(), "vertex row bodies")),
           {first, first + static_cast<std::ptrdiff_t>(row_size)}});
    }
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
  add_field_arrays(mesh, file);
  return file;
}

bool is_resampled_mesh(const UnstructuredMesh& mesh) {
  return mesh.kind == CellKind::kTetrahedra &&
         std::any_of(mesh.field_arrays.begin(), mesh.field_arrays.end(),
                     [](const NamedArray& array) { return array.name == "adamas version"; });
}

ResampledMesh from_unstructured_mesh(const UnstructuredMesh& file, const std::string& source) {
  const Arrays arrays(file.field_arrays, "adamas ", source), cells(file.cell_arrays, "", source),
      points(file.point_arrays, "", source);
  if (!is_resampled_mesh(file)) fail("{}: expected a mesh written by adamas resample, found another", source);
  if (const auto& version = arrays.get<Integers>("version", 1); version[0] != kVersion) {
    fail("{}: expected version {} of a resampled mesh, found {}", source, kVersion, version[0]);
  }
  ResampledMesh mesh;
  const auto& origin = arrays.get<Strings>("source");
  mesh.source = origin.empty() ? source : origin[0];
  const auto& box = arrays.get<Doubles>("box", 6);
  mesh.box = {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
  mesh.points = file.points;
  read_table(arrays, mesh);
  const std::size_t row_size = read_fields(arrays, mesh);
  read_vertices(arrays, points.get<Integers>("body", mesh.points.size()), row_size, mesh);

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
  mesh.validate();
  return mesh;
}

}  // namespace adamas
