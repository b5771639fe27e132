#include "workflow/input/read_input.h"

#include <algorithm>

#include "adamas/file_names.h"
#include "adamas/text.h"
#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/base/notes.h"
#include "core/io/array_names.h"
#include "core/io/field_assembly.h"
#include "core/io/grid_axes.h"
#include "core/io/grid_centering.h"
#include "core/io/hdf5_layout.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/labelled_network.h"
#include "core/io/mesh_data_reader.h"
#include "core/io/mesh_set_surfaces.h"
#include "core/io/multi_material_reader.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/api/input.h"
#include "interfaces/network/domain_faces.h"
#include "interfaces/network/edge_fans.h"
#include "interfaces/network/interface_mesh_check.h"
#include "workflow/input/left_out_steps.h"
#include "workflow/input/load_mesh.h"
#include "workflow/input/memory_need.h"

namespace adamas {

using namespace interfaces;
using namespace io;
using namespace workflow;

namespace {

/// The margin of the domain round interfaces, relative to their size, where no domain is given.
constexpr double kMargin = 0.05;

/// Notes repairs of volume fractions, unless they are round-off.
void note_mended_fractions(const FractionReport& r, const std::string& source, Progress& progress) {
  if (r.renormalised == 0 && r.negative == 0) return;
  std::string what;
  const auto add = [&what](const std::string& text) { what += (what.empty() ? "" : ", ") + text; };
  if (r.renormalised > 0) {
    const std::string low = fmt::format("{:.6g}", r.sum_min), high = fmt::format("{:.6g}", r.sum_max);
    const std::string sums = low == high ? "" : fmt::format(" (sums from {} to {})", low, high);
    add(counted(r.renormalised, "site") + " scaled to 1" + sums);
  }
  if (r.negative > 0) add(counted(r.negative, "negative fraction") + " set to 0");
  if (r.traces > 0) add(counted(r.traces, "trace") + " below a millionth set to 0");
  note(progress, "{}: volume fractions were mended: {}", source, what);
}

/// Throws where --extensive names no field. Letter case counts as in all other options, although the reader
/// of the data ignores it.
void check_extensive(const InputOptions& options, const MultiMaterialData& data) {
  for (const std::string& name : options.data.extensive) {
    const auto same = [&name](const Field& field) { return field.name == name; };
    if (std::any_of(data.fields.begin(), data.fields.end(), same)) continue;
    std::string known;
    for (const Field& field : data.fields) known += (known.empty() ? "'" : ", '") + field.name + "'";
    fail("{}: --extensive: expected one of its fields ({}), found '{}'", data.source, known, name);
  }
}

/// Returns the name of the input in messages: its main file, and where that is the first of several, the
/// number of the others.
std::string input_name(const InputOptions& options) {
  const auto& fractions = options.data.fractions;
  const std::string path = options.path.string();
  const bool first = fractions.size() > 1 && fractions.front().second == path;
  return first ? fmt::format("{} and {}", path, counted(fractions.size() - 1, "more file")) : path;
}

InterfaceMesh read_surface_between(const GivenSurface& surface) {
  check_input_file(surface.file);
  if (!is_surface_file(surface.file)) {
    fail("{}: expected a surface (.obj, .off, .ply, .stl) for --interface, found something else",
         surface.file.string());
  }
  return read_surface(surface.file, surface.front, surface.back);
}

/// Returns the faces of the box round interfaces at which they end, as bits (domain_faces_at()); 0 if they
/// end elsewhere too, or at a face but not at the opposite one.
unsigned faces_ended_at(const InterfaceMesh& mesh, const Box3& box) {
  unsigned ended_at = 0;
  const EdgeFans fans(mesh, nullptr);
  for (std::size_t edge = 0; edge < fans.size(); ++edge) {
    if (fans.valence(edge) != 1) continue;
    const auto [low, high] = fans.ends(edge);
    const unsigned faces = domain_faces_at(box, mesh.points[low]) & domain_faces_at(box, mesh.points[high]);
    if (faces == 0) return 0;
    ended_at |= faces;
  }
  constexpr unsigned kLeastFaces = 1u | 4u | 16u;
  const bool opposite = (ended_at & kLeastFaces) == (ended_at >> 1 & kLeastFaces);
  return opposite ? ended_at : 0;
}

/// Returns the domain of interfaces for which none is given: the box round them, with a margin along the axes
/// along which they do not end at its faces.
Box3 domain_of(const InterfaceMesh& mesh) {
  check_interface_arrays(mesh);
  Box3 box;
  for (const Vec3& p : mesh.points) box.extend(p);
  const unsigned ended_at = faces_ended_at(mesh, box);
  const Vec3 size = box.size();
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_flat = !(size[axis] > 0);
    if (!is_flat && (ended_at >> (2 * axis) & 1u) != 0) continue;
    const double margin = kMargin * (is_flat ? box.diagonal() : size[axis]);
    box.min[axis] -= margin;
    box.max[axis] += margin;
  }
  return box;
}

/// Reads a grid without materials, whose arrays are all fields.
MultiMaterialData read_fields(const InputOptions& options) {
  if (options.data.region) wrong_usage("--region: expected a grid with materials");
  GridFile file = read_grid_file(options.path);
  require_laid_out(options.path, file);
  choose_centering(options.path, options.data.centering, Centering::kPoints, file);
  MultiMaterialData data;
  data.source = options.path.string();
  data.grid.nodes = file.nodes;
  if (!file.arrays.empty()) data.grid.centering = file.arrays.front().centering;
  add_fields(std::move(file.arrays), data);
  return data;
}

/// Returns the given option that only a mesh of cells can have; empty where there is none.
std::string mesh_option(const MaterialDataOptions& data) {
  if (data.extrude) return "--extrude";
  if (data.axisymmetric) return "--axisymmetric";
  return data.time ? "--time" : "";
}

/// Returns the options of the data with what the other options say of them; notes go to the progress.
MaterialDataOptions data_options(const InputOptions& options, Progress& progress) {
  MaterialDataOptions how = options.data;
  if (!how.note) how.note = [&progress](const std::string& text) { note(progress, "{}", text); };
  if (options.stack) {
    how.stack_spacing = options.raw.spacing;
    how.stack_origin = options.raw.origin;
  }
  if (!options.region_names.empty() && !how.labels.empty()) {
    how.label_names =
        parse_region_table(read_file(options.region_names), options.region_names.string()).names;
  }
  return how;
}

/// Returns whether the options or the main file name materials.
bool has_materials(const InputOptions& options) {
  if (!options.material_option().empty()) return true;
  const GridFile file = read_grid_file(options.path);
  return std::any_of(file.arrays.begin(), file.arrays.end(),
                     [](const GridArray& array) { return fraction_material(array.name).has_value(); });
}

/// Gives the mesh the materials of the data, in their order; materials that only the mesh has come after
/// them.
void adopt_materials(const MultiMaterialData& data, InterfaceMesh& mesh) {
  const auto renamed = material_numbers(mesh.materials, data.materials, mesh.source, data.source);
  for (InterfaceTriangle& t : mesh.triangles) t.front = renamed[t.front], t.back = renamed[t.back];
  mesh.materials = data.materials;
}

std::shared_ptr<Input::Contents> load_given_interfaces(const InputOptions& options, Progress& progress) {
  if (const std::string option = mesh_option(options.data); !option.empty())
    wrong_usage("{}: expected a mesh of cells as INPUT", option);
  const bool has_path = !options.path.empty();
  const bool gridded = has_path && input_kind(options.path) == InputKind::kGrid;
  if (has_path && !gridded && input_kind(options.path) != InputKind::kNetwork)
    fail("{}: expected a grid or a labelled network beside --interface, found a mesh", options.path.string());
  if (!gridded && !options.grid_option().empty())
    wrong_usage("{}: expected data on a grid as INPUT", options.grid_option());
  progress.step("reading interfaces", -1);
  InterfaceMesh mesh = read_given_interfaces(options);
  std::unique_ptr<MultiMaterialData> data;
  if (gridded && has_materials(options)) {
    data = std::make_unique<MultiMaterialData>(load_data(options, progress));
    adopt_materials(*data, mesh);
  } else if (gridded) {
    data = std::make_unique<MultiMaterialData>(read_fields(options));
    data->materials = mesh.materials;
    data->labels.assign(data->grid.site_count(), 0);
    data->check();
    data->labels.clear();
  }
  std::optional<Box3> box = options.box;
  if (!box && !mesh.triangles.empty()) box = data ? data->grid.domain() : domain_of(mesh);
  if (!box) check_interface_arrays(mesh);
  return std::make_shared<Input::Contents>(std::move(mesh), *box, options.mending, std::move(data));
}

}  // namespace

std::string InputOptions::material_option(const std::string& reconstruction) const {
  if (!data.fractions.empty()) return "--fraction";
  if (!data.fraction_array.empty()) return "--fractions";
  if (data.fraction_scale) return "--fraction-scale";
  if (!data.rest.empty()) return "--rest";
  if (!data.labels.empty()) return "--labels";
  if (!reconstruction.empty()) return reconstruction;
  if (!data.fields.empty()) return "--field";
  if (!data.extensive.empty()) return "--extensive";
  return data.region ? "--region" : raw.option();
}

std::string InputOptions::grid_option(const std::string& reconstruction) const {
  if (!hdf5_layout_texts().empty()) return "--hdf5";
  if (const std::string option = material_option(reconstruction); !option.empty() || !data.centering)
    return option;
  return data.centering == Centering::kCells ? "--cells" : "--points";
}

std::string InputOptions::interface_option() const {
  if (!region_names.empty() && data.labels.empty()) return "--region-names";
  if (box) return "--box";
  if (mending.gaps) return "--weld";
  return mending.tolerant ? "--tolerant" : "";
}

InputOptions with_main_file(const InputOptions& options) {
  InputOptions result = options;
  if (!options.path.empty()) return result;
  if (!options.data.fractions.empty())
    result.path = options.data.fractions.front().second;
  else if (!options.data.fraction_array.empty())
    result.path = options.data.fraction_array;
  else
    result.path = options.data.labels;
  return result;
}

InputOptions needed_main_file(const InputOptions& options, const std::string& expected) {
  InputOptions result = with_main_file(options);
  if (result.path.empty())
    wrong_usage("expected {}, or files in --fraction, --fractions or --labels, found neither", expected);
  return result;
}

InputKind input_kind(const std::filesystem::path& path) {
  if (is_saved_hierarchy(path)) return InputKind::kMesh;
  const InputKind kind = kind_by_format(path);
  return kind == InputKind::kPolygons ? InputKind::kNetwork : kind;
}

bool has_given_interfaces(const InputOptions& options) {
  return !options.surfaces.empty() ||
         (!options.path.empty() && input_kind(options.path) == InputKind::kNetwork);
}

void check(const ReconstructOptions& options, const InputOptions& input) {
  if (has_given_interfaces(with_main_file(input)))
    refuse_reconstruction({.smooth_labels = options.smooth_labels, .fractions = options.fractions});
}

void check_region_names(const InputOptions& options) {
  if (options.region_names.empty() || !options.data.labels.empty()) return;
  const std::string extension = file_extension(options.path);
  const bool has_names = extension == ".vtp" || extension == ".ply";
  if (options.path.empty() || has_names || input_kind(options.path) != InputKind::kNetwork)
    wrong_usage("--region-names: expected --labels, or a labelled network (.arec, .txt) as INPUT");
}

Input read_input(const InputOptions& options, Progress& progress) {
  const LoopProgress loops(progress);
  return Input(load_contents(options, progress));
}

void write_set_surfaces(const std::filesystem::path& path, const Input& input, Progress& progress) {
  const MeshData* cells = input.contents().cells.get();
  if (cells == nullptr || cells->sets.empty())
    wrong_usage("--side-sets: expected an INPUT with side sets or node sets, found none in {}",
                input.source());
  const UnstructuredMesh surfaces = mesh_set_surfaces(*cells);
  std::vector<bool> is_shown(cells->sets.size(), false);
  for (const std::int32_t set : std::get<std::vector<std::int32_t>>(surfaces.cell_arrays.front().values))
    is_shown[static_cast<std::size_t>(set)] = true;
  for (std::size_t n = 0; n < is_shown.size(); ++n) {
    if (!is_shown[n]) note(progress, "{}: '{}' has no face", input.source(), cells->sets[n].name);
  }
  write_unstructured_mesh(path, surfaces);
}

namespace workflow {

std::optional<RawVolume> raw_volume_of(const InputOptions& options) {
  std::optional<RawVolume> raw = raw_volume(options.raw);
  if (options.stack) {
    if (!is_file_pattern(options.path))
      wrong_usage("--stack: expected a pattern of names in quotes, as \"labels_*.tif\", found {}",
                  options.path.string());
    RawOptions rest = options.raw;
    rest.spacing = rest.origin = {};
    if (const std::string option = rest.option(); !option.empty())
      wrong_usage("{}: expected a file without a header, found a stack of pictures", option);
    return {};
  }
  if (const std::string option = options.raw.option(); !raw && !option.empty())
    wrong_usage("{}: expected --dimensions as well", option);
  return raw;
}

InterfaceMesh read_given_interfaces(const InputOptions& options) {
  std::vector<InterfaceMesh> meshes;
  const bool network = !options.path.empty() && input_kind(options.path) == InputKind::kNetwork;
  const std::string extension = file_extension(options.path);
  const bool named = network && (extension == ".vtp" || extension == ".ply");
  check_region_names(options);
  if (network) {
    check_input_file(options.path);
    meshes.push_back(named ? read_interface_mesh(options.path)
                           : read_labelled_network(options.path, options.region_names));
  }
  for (const GivenSurface& surface : options.surfaces) meshes.push_back(read_surface_between(surface));
  if (meshes.size() == 1) return std::move(meshes.front());
  InterfaceMesh merged = merge(meshes);
  if (merged.source.empty()) merged.source = meshes.front().source;
  return merged;
}

MultiMaterialData load_data(const InputOptions& given, Progress& progress) {
  const InputOptions options = needed_main_file(given);
  if (const std::string option = mesh_option(options.data); !option.empty())
    wrong_usage("{}: expected a mesh of cells as INPUT, found {}", option, options.path.string());
  const std::optional<RawVolume> raw = raw_volume_of(options);
  const MaterialDataOptions how = data_options(options, progress);
  check_input_file(options.path);
  const std::string path = options.path.string();
  switch (input_kind(options.path)) {
    case InputKind::kMesh:
    case InputKind::kCells:
      fail("{}: expected data on a grid, found a mesh", path);
    case InputKind::kPolygons:
    case InputKind::kNetwork:
      fail("{}: expected data on a grid, found interface meshes", path);
    case InputKind::kSurface:
      fail("{}: expected data on a grid, found a surface (give it as --interface FILE=FRONT,BACK)", path);
    case InputKind::kGrid:
      break;
  }
  MultiMaterialData data = read_multi_material_data(options.path, how, progress, raw);
  data.source = input_name(options);
  check_extensive(options, data);
  note_mended_fractions(data.report, data.source, progress);
  return data;
}

MeshData load_mesh_data(const InputOptions& options, Progress& progress) {
  if (const std::string option = options.raw.option(); !option.empty())
    wrong_usage("{}: expected a file without a header, found {}", option, options.path.string());
  const MaterialDataOptions how = data_options(options, progress);
  check_input_file(options.path);
  MeshData data = read_mesh_data(options.path, how, progress);
  note_mended_fractions(data.report, data.source, progress);
  return data;
}

std::shared_ptr<Input::Contents> load_contents(const InputOptions& given, Progress& progress) {
  const InputOptions options = with_main_file(given);
  static_cast<void>(raw_volume_of(options));
  if (has_given_interfaces(options)) return load_given_interfaces(options, progress);
  if (options.path.empty())
    wrong_usage(
        "expected an INPUT, --interface, or files in --fraction, --fractions or --labels, found none");
  if (options.box) wrong_usage("--box: expected given interfaces (for a grid, --region crops)");
  check_region_names(options);
  if (options.mending.tolerant || options.mending.gaps)
    wrong_usage("{}: expected given interfaces", options.mending.tolerant ? "--tolerant" : "--weld");
  check_input_file(options.path);
  if (input_kind(options.path) == InputKind::kCells) {
    check_memory_of_mesh_header(options);
    auto data = std::make_unique<MeshData>(load_mesh_data(options, progress));
    check_memory_of_mesh(options, *data);
    auto contents = std::make_shared<Input::Contents>(std::move(data));
    contents->facts.name = options.path.string();
    return contents;
  }
  check_memory_of_headers(options);
  auto data = std::make_unique<MultiMaterialData>(load_data(options, progress));
  check_memory_of_data(options, *data);
  auto contents = std::make_shared<Input::Contents>(std::move(data));
  contents->facts.name = options.path.string();
  return contents;
}

ReconstructionOptions reconstruction_of(const ResampleOptions& options) {
  return {.smooth_labels = options.smooth_labels, .fractions = options.fractions};
}

LoadedInput load_input(const InputOptions& options, const ReconstructionOptions& reconstruction,
                       Progress& progress, const InputCheck& check) {
  if (has_given_interfaces(with_main_file(options))) refuse_reconstruction(reconstruction);
  const std::shared_ptr<Input::Contents> contents = load_contents(options, progress);
  if (check) check_step([&] { check(contents->facts); });
  LoadedInput input;
  input.source = contents->source(reconstruction, progress);
  input.data = std::move(contents->data);
  input.cells = std::move(contents->cells);
  return input;
}

IdVector<MaterialId, MaterialId> material_numbers(const IdVector<MaterialId, std::string>& names,
                                                  const IdVector<MaterialId, std::string>& among,
                                                  std::string_view source, std::string_view whose) {
  IdVector<MaterialId, MaterialId> numbers;
  for (const std::string& name : names) {
    const auto found = std::find(among.begin(), among.end(), name);
    if (found == among.end()) {
      std::string known;
      for (const std::string& m : among) known += (known.empty() ? "" : ", ") + m;
      fail("{}: expected the materials of {} ({}), found '{}'", source, whose, known, name);
    }
    numbers.push_back(MaterialId(static_cast<std::size_t>(found - among.begin())));
  }
  return numbers;
}

}  // namespace workflow

}  // namespace adamas
