#include "interfaces/selection/saved_hierarchy_file.h"

#include <cmath>
#include <limits>

#include "interfaces/mesh/mesh_arrays.h"

namespace adamas::interfaces {

namespace {

using Integers = std::vector<std::int32_t>;
using Doubles = std::vector<double>;
using Bytes = std::vector<std::uint8_t>;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

Integers integers(const std::vector<std::uint32_t>& values) { return {values.begin(), values.end()}; }

/// Files of older versions have no certificates.
constexpr int kFirstCertifiedVersion = 2;
/// The number of distances of a certificate: upper and lower bounds for all interfaces, for the materials'
/// boundaries and for junction lines.
constexpr int kDistances = 6;
constexpr const char* kGreatestError = "greatest error";

std::string field_array(const std::string& field, const std::string& name) {
  return "fields/" + field + "/" + name;
}

std::string field_array(std::size_t field, const std::string& name) {
  return field_array(std::to_string(field), name);
}

void add_cells(const ResampledMesh& tree, std::vector<NamedArray>& arrays) {
  Integers vertices;
  Bytes level, phase;
  Doubles errors;
  for (const ResampledMesh::Cell& cell : tree.cells) {
    for (const std::uint32_t v : cell.vertices) vertices.push_back(static_cast<std::int32_t>(v));
    level.push_back(cell.level);
    phase.push_back(cell.phase);
    errors.push_back(cell.interface_error);
  }
  arrays.push_back({"tetrahedra/vertices", 4, std::move(vertices)});
  arrays.push_back({"tetrahedra/level", 1, std::move(level)});
  arrays.push_back({"tetrahedra/phase", 1, std::move(phase)});
  arrays.push_back({"tetrahedra/interface error", 1, std::move(errors)});
}

void add_vertices(const ResampledMesh& tree, std::vector<NamedArray>& arrays) {
  Doubles positions;
  Integers bodies;
  for (const Vec3& p : tree.points) positions.insert(positions.end(), {p.x, p.y, p.z});
  for (const VertexRecord& v : tree.vertices)
    bodies.push_back(static_cast<std::int32_t>(v.distances.body.value));
  arrays.push_back({"vertices/position", 3, std::move(positions)});
  arrays.push_back({"vertices/body", 1, std::move(bodies)});
}

void add_field_errors(const SavedHierarchy& hierarchy, std::size_t field, std::vector<NamedArray>& arrays) {
  Doubles greatest, reducible, sum;
  Integers counts;
  for (const FieldError& error : hierarchy.measured[field]) {
    greatest.push_back(error.max);
    reducible.push_back(error.reducible);
    sum.push_back(error.sum);
    for (const std::uint32_t count : error.counts) counts.push_back(static_cast<std::int32_t>(count));
    counts.push_back(static_cast<std::int32_t>(error.displaced));
    counts.push_back(static_cast<std::int32_t>(error.without_value));
  }
  arrays.push_back({field_array(field, kGreatestError), 1, std::move(greatest)});
  arrays.push_back({field_array(field, "reducible error"), 1, std::move(reducible)});
  arrays.push_back({field_array(field, "sum of errors"), 1, std::move(sum)});
  arrays.push_back({field_array(field, "elements"), static_cast<int>(kElementKinds + 2), std::move(counts)});
  arrays.push_back({field_array(field, "nested error"), 1, hierarchy.field_errors[field]});
}

void add_certificates(const SavedHierarchy& hierarchy, std::vector<NamedArray>& arrays) {
  Doubles distances;
  Integers materials;
  for (const InterfaceCertificate& c : hierarchy.certificates) {
    const InterfaceDistance junctions = c.junctions.value_or(InterfaceDistance{kNothing, kNothing, {}});
    for (const InterfaceDistance& d : {c.networks, c.materials, junctions})
      distances.insert(distances.end(), {d.upper, d.lower});
    materials.push_back(static_cast<std::int32_t>(c.worst_material.value));
  }
  arrays.push_back({"certified/distances", kDistances, std::move(distances)});
  arrays.push_back({"certified/worst material", 1, std::move(materials)});
}

std::vector<std::uint32_t> read_indices(const ArrayReader& arrays, const std::string& name, std::size_t end) {
  std::vector<std::uint32_t> result;
  for (const std::int32_t value : arrays.get<Integers>(name))
    result.push_back(arrays.index(value, end, name));
  return result;
}

void read_cells(const ArrayReader& arrays, ResampledMesh& tree) {
  const auto& errors = arrays.get<Doubles>("tetrahedra/interface error");
  const std::size_t count = errors.size();
  const auto& vertices = arrays.get<Integers>("tetrahedra/vertices", 4 * count);
  const auto& level = arrays.get<Bytes>("tetrahedra/level", count);
  const auto& phase = arrays.get<Bytes>("tetrahedra/phase", count);
  for (std::size_t c = 0; c < count; ++c) {
    ResampledMesh::Cell cell{{}, level[c], phase[c], errors[c]};
    for (std::size_t i = 0; i < 4; ++i)
      cell.vertices[i] = arrays.index(vertices[4 * c + i], tree.points.size(), "tetrahedra/vertices");
    tree.cells.push_back(cell);
  }
}

void read_field_errors(const ArrayReader& arrays, std::size_t field, SavedHierarchy& hierarchy) {
  constexpr std::size_t kColumns = kElementKinds + 2;
  const std::size_t cells = hierarchy.tree.cells.size();
  const std::vector<double>& greatest = hierarchy.tree.field_errors[field];
  const auto& reducible = arrays.get<Doubles>(field_array(field, "reducible error"), cells);
  const auto& sum = arrays.get<Doubles>(field_array(field, "sum of errors"), cells);
  const auto& counts = arrays.get<Integers>(field_array(field, "elements"), kColumns * cells);
  std::vector<FieldError>& errors = hierarchy.measured.emplace_back(cells);
  for (std::size_t c = 0; c < cells; ++c) {
    errors[c].max = greatest[c];
    errors[c].reducible = reducible[c];
    errors[c].sum = sum[c];
    const auto count = [&](std::size_t column) {
      return arrays.index(counts[kColumns * c + column], std::numeric_limits<std::int32_t>::max(),
                          field_array(field, "elements"));
    };
    for (std::size_t kind = 0; kind < kElementKinds; ++kind) errors[c].counts[kind] = count(kind);
    errors[c].displaced = count(kElementKinds);
    errors[c].without_value = count(kElementKinds + 1);
  }
  hierarchy.field_errors.push_back(arrays.get<Doubles>(field_array(field, "nested error")));
}

/// The places of distances are not in the file.
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr Vec3 kUnknown{kNaN, kNaN, kNaN};

void read_certificates(const ArrayReader& arrays, SavedHierarchy& hierarchy) {
  const auto& materials = arrays.get<Integers>("certified/worst material");
  const auto& distances = arrays.get<Doubles>("certified/distances", kDistances * materials.size());
  for (std::size_t c = 0; c < materials.size(); ++c) {
    const double* d = distances.data() + kDistances * c;
    InterfaceCertificate& certificate = hierarchy.certificates.emplace_back();
    certificate.networks = {d[0], d[1], kUnknown};
    certificate.materials = {d[2], d[3], kUnknown};
    if (!std::isnan(d[4])) certificate.junctions = InterfaceDistance{d[4], d[5], kUnknown};
    certificate.worst_material =
        MaterialId(arrays.index(materials[c], hierarchy.tree.materials.size(), "certified/worst material"));
  }
}

/// Reads the tree, the greatest errors of fields in its cells, and the interface error that it was built for.
SavedHierarchy read_tree(const std::vector<NamedArray>& list, const std::string& source) {
  const ArrayReader arrays(list, "", source), known(list, "known/", source);
  SavedHierarchy result;
  result.tree.source = source;
  const auto& bodies = arrays.get<Integers>("vertices/body");
  const auto& positions = arrays.get<Doubles>("vertices/position", 3 * bodies.size());
  for (std::size_t v = 0; v < bodies.size(); ++v)
    result.tree.points.push_back({positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]});
  read_knowledge(known, bodies, result.tree);
  read_cells(arrays, result.tree);
  const std::size_t cells = result.tree.cells.size();
  result.split_cells = read_indices(arrays, "diamonds/split tetrahedra", cells);
  result.first_cells = read_indices(arrays, "diamonds/first", result.split_cells.size() + 1);
  result.new_vertices = read_indices(arrays, "diamonds/vertex", result.tree.points.size());
  if (2 * result.split_cells.size() > cells)
    fail("{}: expected two children for each split tetrahedron, found fewer", source);
  result.root_count = static_cast<std::uint32_t>(cells - 2 * result.split_cells.size());
  for (std::size_t f = 0; f < result.tree.fields.size(); ++f)
    result.tree.field_errors.push_back(arrays.get<Doubles>(field_array(f, kGreatestError), cells));
  result.interface_target = arrays.get<Doubles>("built for/interface error", 1)[0];
  return result;
}

}  // namespace

std::vector<NamedArray> to_arrays(const SavedHierarchy& hierarchy) {
  std::vector<NamedArray> arrays;
  add_knowledge(hierarchy.tree, "known/", arrays);
  add_vertices(hierarchy.tree, arrays);
  add_cells(hierarchy.tree, arrays);
  arrays.push_back({"diamonds/split tetrahedra", 1, integers(hierarchy.split_cells)});
  arrays.push_back({"diamonds/first", 1, integers(hierarchy.first_cells)});
  arrays.push_back({"diamonds/vertex", 1, integers(hierarchy.new_vertices)});
  arrays.push_back({"diamonds/nested interface error", 1, hierarchy.interface_estimates});
  arrays.push_back({"diamonds/certified interface error", 1, hierarchy.interface_errors});
  add_certificates(hierarchy, arrays);
  for (std::size_t f = 0; f < hierarchy.tree.fields.size(); ++f) add_field_errors(hierarchy, f, arrays);
  Doubles targets;
  for (const auto& target : hierarchy.field_targets) targets.push_back(target.value_or(kNothing));
  arrays.push_back({"built for/interface error", 1, Doubles{hierarchy.interface_target}});
  arrays.push_back({"built for/field errors", 1, std::move(targets)});
  arrays.push_back({"input/voxel", 1, Doubles{hierarchy.voxel}});
  arrays.push_back(
      {"input/volumes", 1, Doubles(hierarchy.input_volumes.begin(), hierarchy.input_volumes.end())});
  return arrays;
}

SavedHierarchy from_arrays(const std::vector<NamedArray>& list, const std::string& source, int version) {
  const ArrayReader arrays(list, "", source);
  SavedHierarchy result = read_tree(list, source);
  result.interface_estimates =
      arrays.get<Doubles>("diamonds/nested interface error", result.new_vertices.size());
  result.interface_errors = result.interface_estimates;
  if (version >= kFirstCertifiedVersion) {
    result.interface_errors =
        arrays.get<Doubles>("diamonds/certified interface error", result.new_vertices.size());
    read_certificates(arrays, result);
  }
  for (std::size_t f = 0; f < result.tree.fields.size(); ++f) read_field_errors(arrays, f, result);
  for (const double target : arrays.get<Doubles>("built for/field errors"))
    result.field_targets.push_back(std::isnan(target) ? std::nullopt : std::optional(target));
  result.voxel = arrays.get<Doubles>("input/voxel", 1)[0];
  const auto& volumes = arrays.get<Doubles>("input/volumes");
  if (!volumes.empty() && volumes.size() != result.tree.materials.size())
    fail("{}: expected a volume of each of {} materials, found {}", source, result.tree.materials.size(),
         volumes.size());
  result.input_volumes.assign(volumes.begin(), volumes.end());
  result.validate(source);
  return result;
}

SavedHierarchy tree_from_arrays(const std::vector<NamedArray>& list, const std::string& source) {
  SavedHierarchy result = read_tree(list, source);
  result.validate_tree(source);
  return result;
}

std::vector<std::string> names_of_tree_arrays() {
  std::vector<std::string> names = names_of_arrays();
  std::erase_if(names, [](const std::string& name) {
    for (const char* needed : {"known/", "vertices/", "tetrahedra/"}) {
      if (name.starts_with(needed)) return false;
    }
    for (const char* needed :
         {"diamonds/split tetrahedra", "diamonds/first", "diamonds/vertex", "built for/interface error"}) {
      if (name == needed) return false;
    }
    return name != field_array("#", kGreatestError);
  });
  return names;
}

std::vector<std::string> names_of_arrays() {
  SavedHierarchy example;
  example.tree.fields.resize(1);
  example.field_errors.resize(1);
  example.measured.resize(1);
  const std::string first = field_array("0", ""), any = field_array("#", "");
  std::vector<std::string> names;
  for (const NamedArray& array : to_arrays(example)) {
    const bool numbered = array.name.rfind(first, 0) == 0;
    names.push_back(numbered ? any + array.name.substr(first.size()) : array.name);
  }
  return names;
}

}  // namespace adamas::interfaces
