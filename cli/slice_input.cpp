#include "cli/slice_input.h"

#include <algorithm>
#include <array>

#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/usage.h"
#include "core/io/input_file.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/network/network_mesh.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "interfaces/selection/selection.h"
#include "workflow/input/saved_hierarchy.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;
using namespace workflow;

namespace {

/// Brings the data's materials into the order of the mesh's, by their names; the mesh may have more
/// materials.
void adopt_materials(const ResampledMesh& mesh, MultiMaterialData& data) {
  const auto there = workflow::material_numbers(data.materials, mesh.materials, data.source, "the mesh");
  const std::size_t count = mesh.materials.size();
  const auto reorder = [&]<class Values>(IdVector<MaterialId, Values>& values) {
    IdVector<MaterialId, Values> result(count);
    for (MaterialId m(0); m.value < values.size(); ++m.value) result[there[m]] = std::move(values[m]);
    values = std::move(result);
  };
  data.materials = mesh.materials;
  for (std::uint16_t& label : data.labels) label = static_cast<std::uint16_t>(there[MaterialId(label)].value);
  if (!data.fractions.empty()) {
    reorder(data.fractions);
    for (auto& values : data.fractions) values.resize(data.grid.site_count());
  }
  for (Field& field : data.fields) {
    if (field.per_material()) reorder(field.material_values);
  }
}

void check_box(const ResampledMesh& mesh, const std::string& mesh_name, const MultiMaterialData& data) {
  constexpr double kTolerance = 1e-6;
  const Box3 box = data.grid.domain();
  const double off = std::max(distance(box.min, mesh.box.min), distance(box.max, mesh.box.max));
  if (off <= kTolerance * mesh.box.diagonal()) return;
  fail("{}: expected the box of {}, {}, found {} (a --region has to be the same for both)", data.source,
       mesh_name, box_text(mesh.box), box_text(box));
}

void load_original(const InputArguments& options, Console& console, SliceInput& input) {
  const bool gridded = !options.path.empty() && input_kind(options.path) == InputKind::kGrid;
  const bool given = has_given_interfaces(options);
  if (given) refuse_reconstruction_options(options);
  if (given) input.interfaces = workflow::read_given_interfaces(to_input_options(options));
  if (!given && !options.region_names.empty()) {
    wrong_usage("--region-names: expected a labelled network (.arec, .txt)");
  }
  if (!gridded && given) {
    if (options.grid_option().empty()) return;
    wrong_usage("{}: expected data on a grid", options.grid_option());
  }
  input.data = std::make_unique<MultiMaterialData>(load_data(options, console));
  if (!input.mesh) return;
  // With given interfaces the mesh may have a box of its own.
  if (!given) check_box(*input.mesh, input.name, *input.data);
  adopt_materials(*input.mesh, *input.data);
}

}  // namespace

ResampledMesh load_resampled_mesh(const std::string& path, Console& console) {
  if (workflow::is_saved_hierarchy(path)) return whole_mesh(workflow::load_saved_hierarchy(path, console));
  check_input_file(path);
  console.step("reading " + path, -1);
  const UnstructuredMesh mesh = read_unstructured_mesh(path);
  if (!is_resampled_mesh(mesh)) {
    fail("{}: expected a mesh written by adamas resample, found another one", path);
  }
  return from_unstructured_mesh(mesh, path);
}

SliceInput load_slice_input(const InputArguments& given, const std::string& original, bool with_interfaces,
                            const std::function<void(const SliceInput&)>& check, Console& console) {
  const InputArguments options = with_needed_main_file(given);
  SliceInput input;
  input.name = options.path;
  InputArguments from = options;
  check_input_file(options.path);
  const InputKind kind = input_kind(options.path);
  const bool meshed = kind == InputKind::kMesh;
  if (!meshed && !original.empty())
    wrong_usage("--original: expected a resampled mesh (.vtu) as INPUT, found {}", options.path);
  if (kind == InputKind::kNetwork) {
    workflow::LoadedInput read = load_input(options, console);
    input.interfaces = network_mesh(*read.source.network, read.source.materials, read.source.name);
    input.network = std::move(read.source);
    check(input);
    return input;
  }
  if (!options.box.empty() || !options.weld.empty() || options.tolerant) {
    wrong_usage("{}: expected interfaces as INPUT, found {}",
                !options.box.empty() ? "--box" : (!options.weld.empty() ? "--weld" : "--tolerant"),
                options.path);
  }
  if (meshed) {
    input.mesh = load_resampled_mesh(options.path, console);
    from.path = original;
    if (!original.empty()) check_input_file(original);
    const std::string unused =
        options.grid_option().empty() ? options.interface_option() : options.grid_option();
    if (original.empty() && !unused.empty()) wrong_usage("{}: expected --original DATA", unused);
  } else if (kind == InputKind::kSurface) {
    fail("{}: expected data on a grid, a resampled mesh (.vtu) or a network, found a surface", options.path);
  }
  if (!from.path.empty() || !from.interfaces.empty()) load_original(from, console, input);
  check(input);
  if (!input.data || input.interfaces || !with_interfaces || input.plain()) return input;
  input.interfaces =
      Reconstruction(*input.data, reconstruction_options(options, *input.data), console).mesh();
  return input;
}

}  // namespace adamas::cli
