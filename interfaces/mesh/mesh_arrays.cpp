#include "interfaces/mesh/mesh_arrays.h"

namespace adamas::interfaces {

namespace {

using Integers = std::vector<std::int32_t>;
using Doubles = std::vector<double>;
using Strings = std::vector<std::string>;

std::int32_t integer(std::uint32_t value) { return static_cast<std::int32_t>(value); }

void read_table(const ArrayReader& arrays, ResampledMesh& mesh) {
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

std::size_t read_fields(const ArrayReader& arrays, ResampledMesh& mesh) {
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

void read_vertices(const ArrayReader& arrays, const Integers& bodies, std::size_t row_size,
                   ResampledMesh& mesh) {
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

void add_knowledge(const ResampledMesh& mesh, const std::string& prefix, std::vector<NamedArray>& arrays) {
  const auto add = [&](const std::string& name, auto values, int components = 1) {
    arrays.push_back({prefix + name, components, std::move(values)});
  };
  add("source", Strings{mesh.source});
  add("box",
      Doubles{mesh.box.min.x, mesh.box.min.y, mesh.box.min.z, mesh.box.max.x, mesh.box.max.y, mesh.box.max.z},
      3);
  add("materials", Strings(mesh.materials.begin(), mesh.materials.end()));
  Integers bodies, interfaces;
  for (const MaterialId m : mesh.table.body_materials()) bodies.push_back(integer(m.value));
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

void read_knowledge(const ArrayReader& arrays, const Integers& bodies, ResampledMesh& mesh) {
  if (const auto& origin = arrays.get<Strings>("source"); !origin.empty()) mesh.source = origin[0];
  const auto& box = arrays.get<Doubles>("box", 6);
  mesh.box = {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
  read_table(arrays, mesh);
  const std::size_t row_size = read_fields(arrays, mesh);
  if (bodies.size() != mesh.points.size())
    fail("{}: expected a body of each of {} vertices, found {}", mesh.source, mesh.points.size(),
         bodies.size());
  read_vertices(arrays, bodies, row_size, mesh);
}

}  // namespace adamas::interfaces
