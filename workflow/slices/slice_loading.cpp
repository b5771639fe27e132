#include "workflow/slices/slice_loading.h"

#include <algorithm>
#include <array>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/input_file.h"
#include "interfaces/api/input.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/reconstruction/label_parts.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "workflow/input/load_mesh.h"
#include "workflow/input/read_input.h"

namespace adamas::workflow {

using namespace interfaces;
using namespace io;

namespace {

/// Brings the data's materials into the order of the mesh's, by their names; the mesh may have more
/// materials.
void adopt_materials(const ResampledMesh& mesh, MultiMaterialData& data) {
  const auto there = material_numbers(data.materials, mesh.materials, data.source, "the mesh");
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

/// The name, on the command line, of the first option given that says how interfaces are reconstructed.
std::string reconstruction_option(const SliceRequest& request) {
  return ReconstructOptions{request.smooth_labels, request.fractions, {}}.option();
}

void check_box(const ResampledMesh& mesh, const std::string& mesh_name, const MultiMaterialData& data) {
  constexpr double kTolerance = 1e-6;
  const Box3 box = data.grid.domain();
  const double off = std::max(distance(box.min, mesh.box.min), distance(box.max, mesh.box.max));
  if (off <= kTolerance * mesh.box.diagonal()) return;
  fail("{}: expected the box of {}, {}, found {} (a --region has to be the same for both)", data.source,
       mesh_name, box_text(mesh.box), box_text(box));
}

void load_original(const SliceRequest& request, const InputOptions& options, Progress& progress,
                   SliceInput& input) {
  const bool gridded = !options.path.empty() && input_kind(options.path) == InputKind::kGrid;
  const bool given = has_given_interfaces(options);
  if (given) refuse_reconstruction(reconstruction_of(request));
  if (given) input.interfaces = read_given_interfaces(options);
  if (!given) check_region_names(options);
  if (!gridded && given) {
    const std::string option = grid_option(request, false);
    if (option.empty()) return;
    wrong_usage("{}: expected data on a grid", option);
  }
  const InputOptions from = needed_main_file(options);
  input.data = std::make_unique<MultiMaterialData>(load_data(from, progress));
  input.colours.merge(find_named_colours(from.path, from.region_names));
  if (!input.mesh) return;
  // With given interfaces the mesh may have another box.
  if (!given) check_box(*input.mesh, input.name, *input.data);
  adopt_materials(*input.mesh, *input.data);
}

/// Reconstructs the interfaces that a plane cuts: all of them, or those near the plane where these are the
/// same.
InterfaceMesh interfaces_to_cut(const MultiMaterialData& data, const ReconstructionOptions& options,
                                const Plane& plane, Progress& progress) {
  if (!data.labels.empty() && !options.smooth_labels) {
    if (const auto parts = LabelParts::make(data, progress)) return parts->near_plane(data, plane);
  }
  Reconstruction reconstruction(data, options, progress);
  return reconstruction.take_mesh();
}

}  // namespace

std::string grid_option(const SliceRequest& request, bool shown) {
  InputOptions options = request.input;
  if (shown && !request.field.empty()) options.data.fields.emplace_back(request.field, "");
  return options.grid_option(reconstruction_option(request));
}

ReconstructionOptions reconstruction_of(const SliceRequest& request) {
  return {request.smooth_labels, request.fractions};
}

SliceInput load_slice_input(const SliceRequest& request, bool with_interfaces,
                            const std::function<void(const SliceInput&)>& check, Progress& progress) {
  const InputOptions options = needed_main_file(request.input);
  const std::string path = options.path.string();
  SliceInput input;
  input.name = path;
  InputOptions from = options;
  // Data without materials are enough unless an option is about materials.
  from.data.plain =
      request.input.material_option(reconstruction_option(request)).empty() && request.original.empty();
  check_input_file(path);
  const InputKind kind = input_kind(path);
  const bool meshed = kind == InputKind::kMesh;
  if (!meshed && !request.original.empty())
    wrong_usage("--original: expected a resampled mesh (.vtu) as INPUT, found {}", path);
  if (kind == InputKind::kNetwork || kind == InputKind::kCells) {
    LoadedInput read = load_input(options, reconstruction_of(request), progress);
    input.interfaces = network_mesh(*read.source.network, read.source.materials, read.source.name);
    input.network = std::move(read.source);
    input.cells = std::move(read.cells);
    input.colours = find_named_colours(kind == InputKind::kNetwork ? path : "", options.region_names);
    check(input);
    return input;
  }
  // Names of regions also serve for the original interfaces of a mesh.
  InputOptions without_names = options;
  without_names.region_names.clear();
  if (const std::string option = without_names.interface_option(); !option.empty())
    wrong_usage("{}: expected interfaces as INPUT, found {}", option, path);
  if (meshed) {
    input.mesh = load_resampled_mesh(path, progress);
    input.colours = find_named_colours(path, {});
    from.path = request.original;
    if (!request.original.empty()) check_input_file(request.original);
    const std::string of_grid = grid_option(request, false);
    const std::string unused = of_grid.empty() ? options.interface_option() : of_grid;
    if (request.original.empty() && !unused.empty()) wrong_usage("{}: expected --original DATA", unused);
  } else if (kind == InputKind::kSurface) {
    fail("{}: expected data on a grid, a resampled mesh (.vtu) or a network, found a surface", path);
  }
  if (!from.path.empty() || !from.surfaces.empty()) load_original(request, from, progress, input);
  check(input);
  if (!input.data || input.interfaces || !with_interfaces || input.plain()) return input;
  const ReconstructionOptions reconstruction = reconstruction_of(request);
  check_reconstruction(reconstruction, *input.data);
  input.interfaces = interfaces_to_cut(*input.data, reconstruction, request.plane, progress);
  return input;
}

}  // namespace adamas::workflow
