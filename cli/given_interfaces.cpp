#include "cli/given_interfaces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/option_values.h"
#include "cli/usage.h"
#include "core/io/array_names.h"
#include "core/io/field_assembly.h"
#include "core/io/grid_axes.h"
#include "core/io/grid_centering.h"
#include "core/io/input_file.h"
#include "core/io/interface_mesh_io.h"
#include "interfaces/library/input.h"
#include "interfaces/network/check.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;

namespace {

/// By how much the domain extends beyond the interfaces on each side, where no domain is given.
constexpr double kMargin = 0.05;
InterfaceMesh read_surface_option(const std::string& text) {
  const auto [file, pair] = parse_assignment("--interface", text, true);
  const std::size_t comma = pair.find(',');
  const std::string front = pair.substr(0, comma);
  const std::string back = comma == std::string::npos ? "" : pair.substr(comma + 1);
  if (front.empty() || back.empty() || front == back) {
    wrong_usage("--interface: expected FILE=FRONT,BACK with two materials, found '{}'", text);
  }
  check_input_file(file);
  if (!is_surface_file(file)) {
    fail("{}: expected a surface (.obj, .off, .ply, .stl) for --interface, found something else", file);
  }
  return read_surface(file, front, back);
}

Box3 domain_of(const InterfaceMesh& mesh) {
  Box3 box;
  for (const Vec3& p : mesh.points) box.extend(p);
  const Vec3 size = box.size();
  for (int axis = 0; axis < 3; ++axis) {
    const double margin = kMargin * (size[axis] > 0 ? size[axis] : box.diagonal());
    box.min[axis] -= margin;
    box.max[axis] += margin;
  }
  return box;
}

/// Reads a grid without materials, whose arrays are all fields.
MultiMaterialData read_fields(const InputOptions& options) {
  if (!options.region.empty()) wrong_usage("--region: expected a grid with materials");
  GridFile file = read_grid_file(options.path);
  require_laid_out(options.path, file);
  choose_centering(options.path, options.centering(), Centering::kPoints, file);
  MultiMaterialData data;
  data.source = options.path;
  data.grid.nodes = file.nodes;
  if (!file.arrays.empty()) data.grid.centering = file.arrays.front().centering;
  add_fields(std::move(file.arrays), data);
  return data;
}

bool has_materials(const InputOptions& options) {
  if (!options.material_option().empty()) return true;
  const GridFile file = read_grid_file(options.path);
  return std::any_of(file.arrays.begin(), file.arrays.end(),
                     [](const GridArray& array) { return fraction_material(array.name).has_value(); });
}

/// Gives the mesh the materials of the data, in their order; those of the mesh alone come after them.
void adopt_materials(const MultiMaterialData& data, InterfaceMesh& mesh) {
  const auto renamed = material_numbers(mesh.materials, data.materials, mesh.source, data.source);
  for (InterfaceTriangle& t : mesh.triangles) t.front = renamed[t.front], t.back = renamed[t.back];
  mesh.materials = data.materials;
}

/// The greatest width of the gaps that are closed.
ErrorTarget parse_weld(const InputOptions& options) {
  if (options.weld.empty()) return MendingOptions().gaps;
  if (options.weld == "0") return {};
  return parse_error_target("--weld", options.weld);
}

}  // namespace

bool has_given_interfaces(const InputOptions& options) {
  return !options.interfaces.empty() ||
         (!options.path.empty() && input_kind(options.path) == InputKind::kNetwork);
}

InterfaceMesh read_given_interfaces(const InputOptions& options) {
  std::vector<InterfaceMesh> meshes;
  const bool network = !options.path.empty() && input_kind(options.path) == InputKind::kNetwork;
  const std::string extension = file_extension(options.path);
  const bool named = network && (extension == ".vtp" || extension == ".ply");
  if (!options.region_names.empty() && (!network || named)) {
    wrong_usage("--region-names: expected a labelled network (.arec, .txt) as INPUT");
  }
  if (network) {
    check_input_file(options.path);
    meshes.push_back(named ? read_interface_mesh(options.path)
                           : read_labelled_network(options.path, options.region_names));
  }
  for (const std::string& text : options.interfaces) meshes.push_back(read_surface_option(text));
  if (meshes.size() == 1) return std::move(meshes.front());
  InterfaceMesh merged = merge(meshes);
  if (merged.source.empty()) merged.source = meshes.front().source;
  return merged;
}

ResamplingSource load_given_interfaces(const InputOptions& options, std::unique_ptr<MultiMaterialData>& data,
                                       Console& console, const InputCheck& check) {
  const bool gridded = !options.path.empty() && input_kind(options.path) == InputKind::kGrid;
  if (!options.path.empty() && !gridded && input_kind(options.path) != InputKind::kNetwork) {
    fail("{}: expected a grid or a labelled network beside --interface, found a mesh", options.path);
  }
  if (!gridded && !options.grid_option().empty()) {
    wrong_usage("{}: expected data on a grid as INPUT", options.grid_option());
  }
  const ErrorTarget weld = parse_weld(options);
  std::optional<Box3> box;
  if (!options.box.empty()) box = to_box(parse_bounds("--box", options.box));
  console.step("reading interfaces", -1);
  InterfaceMesh mesh = read_given_interfaces(options);
  if (gridded && has_materials(options)) {
    data = std::make_unique<MultiMaterialData>(load_data(options, console));
    adopt_materials(*data, mesh);
  } else if (gridded) {
    data = std::make_unique<MultiMaterialData>(read_fields(options));
    data->materials = mesh.materials;
    data->labels.assign(data->grid.site_count(), 0);
    data->check();
    data->labels.clear();
  }
  if (!box && !mesh.triangles.empty()) box = data ? data->grid.domain() : domain_of(mesh);
  if (!box) check_interface_arrays(mesh);
  Input::Contents contents(std::move(mesh), *box, {weld, options.tolerant}, std::move(data));
  if (check) check(contents.facts);
  ResamplingSource source = contents.source({}, console);
  data = std::move(contents.data);
  return source;
}

}  // namespace adamas::cli
