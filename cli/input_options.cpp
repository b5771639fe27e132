#include "cli/input_options.h"

#include <utility>

#include "adamas/volume_store.h"
#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

std::optional<StandardDeviation> parse_blur(const std::string& option, const std::string& text) {
  if (text == "auto") return StandardDeviation();
  return text == "none" ? 0 : parse_up_to(option, text, FractionOptions::kMostBlur);
}

std::optional<StandardDeviation> parse_fraction_error(const std::string& option, const std::string& text) {
  if (text == "auto") return StandardDeviation();
  return parse_part(option, text, FractionOptions::kMostError);
}

/// "FILE=FRONT,BACK".
GivenSurface parse_surface(const std::string& option, const std::string& text) {
  const auto [file, pair] = parse_assignment(option, text, true);
  const std::size_t comma = pair.find(',');
  const std::string front = pair.substr(0, comma);
  const std::string back = comma == std::string::npos ? "" : pair.substr(comma + 1);
  if (front.empty() || back.empty() || front == back)
    wrong_usage("{}: expected FILE=FRONT,BACK with two materials, found '{}'", option, text);
  return {file, front, back};
}

/// The greatest width of the gaps that are closed.
ErrorTarget parse_weld(const std::string& option, const std::string& text) {
  return text == "0" ? ErrorTarget() : parse_error_target(option, text);
}

std::pair<std::string, std::string> parse_named_file(const std::string& option, const std::string& text) {
  return parse_assignment(option, text);
}

}  // namespace

std::string mesh_files() { return fmt::format("data on a mesh of cells ({})", mesh_endings()); }

std::string grid_files() { return fmt::format("data on a grid ({} and other images)", grid_endings()); }

void add_material_options(const Command& command, InputOptions& options) {
  add_material_options(command, options, "NAME=FILE-or-ARRAY",
                       "One more field, and where its values are; repeatable",
                       [&options](const std::string& option, const std::string& text) {
                         options.data.fields.push_back(parse_assignment(option, text));
                       });
}

void add_material_options(const Command& command, InputOptions& options, const std::string& field_type,
                          const std::string& field, Command::Conversion take_field) {
  const Command input = command.in_group("Input");
  MaterialDataOptions& data = options.data;
  input.add_values("--fraction", "NAME=FILE-or-ARRAY",
                   "A material and where its volume fractions are; repeatable (default: all arrays named "
                   "\"Volume Fraction\")",
                   data.fractions, parse_named_file);
  input.add_converted(
      "--fractions", "[NAMES=]FILE-or-ARRAY",
      "Where the volume fractions of several materials are, one in each component of an array or at each "
      "time (default of their names: what the file calls its components, else ARRAY_1, ARRAY_2, ...)",
      [&data](const std::string& option, const std::string& text) {
        data.fraction_array = text;
        if (text.find('=') == std::string::npos) return;
        const auto [names, file] = parse_assignment(option, text);
        data.fraction_names = split_at_commas(names);
        data.fraction_array = file;
      });
  input.add_value("--fraction-scale", "S", "What a volume fraction of 1 is stored as", data.fraction_scale,
                  parse_positive);
  input.add_option("--rest", "NAME", "One more material, of what the others leave of 1", data.rest);
  input.add_option("--labels", "FILE-or-ARRAY",
                   "Whole numbers that name the material of each cell or point; of a folder of DICOM with "
                   "several series one of them, by its description or UID",
                   data.labels);
  input.add_converted_each("--field", field_type, field, std::move(take_field));
  input
      .add_option("--extensive", "NAME",
                  "A field of amounts per cell, to be divided by the material's volume there; repeatable",
                  data.extensive)
      .one_value_each();
  input.add_converted_each(
      "--hdf5", "KEY=DATASET",
      "Of a file of HDF5: the data set of its nodes, its cells (with base=1 where they "
      "count nodes from 1), the axes x, y and z of a grid, boxes of blocks, or the groups "
      "of its steps or its times; repeatable, as a list in --config",
      [layout = std::vector<std::string>()](const std::string&, const std::string& text) mutable {
        layout.push_back(text);
        set_hdf5_layout(layout);
      });
  input.add_value("--extrude", "H", "Of a mesh of two dimensions: the height of the cells made of it",
                  data.extrude, parse_positive);
  input.add_flag("--axisymmetric",
                 "Of a mesh of two dimensions: it is turned round the axis of y; x is the distance from it",
                 data.axisymmetric);
  input.add_flag(
      "--cells",
      "The values are of cells, whatever the file says (default, where it says nothing, for labels "
      "and volume fractions)",
      [&data] { data.centering = Centering::kCells; });
  input.add_flag("--points", "The values are of points, whatever the file says", [&data] {
    if (data.centering) wrong_usage("--cells and --points: expected one of them");
    data.centering = Centering::kPoints;
  });
  input.add_value("--region", "x0,x1,y0,y1,z0,z1", "Keep what lies in this box", data.region, parse_bounds);
}

void add_reconstruction_options(const Command& command, bool& smooth_labels, FractionOptions& fractions) {
  const Command input = command.in_group("Input");
  input.add_flag("--smooth-labels",
                 "Smooth the staircase of labels, within half a voxel along each axis; volumes stay",
                 smooth_labels);
  input.add_value(
      "--blur", "auto|none|S",
      "How blurred volume fractions are: the standard deviation in cells, or none; auto, which is "
      "the default, reads it off them, place by place",
      fractions.blur, parse_blur);
  input.add_value("--fraction-error", "auto|P|P%",
                  "The standard deviation of errors of volume fractions, within which interfaces are smooth, "
                  "as 2%; auto, which is the default, reads it off them",
                  fractions.error, parse_fraction_error);
  input.add_flag("--keep-dispersed",
                 "Draw islands round volume fractions that no interface explains, in place of counting them "
                 "as dispersed volume",
                 fractions.keep_dispersed);
}

void add_region_names(const Command& command, InputOptions& options) {
  command.in_group("Input").add_file("--region-names", "FILE",
                                     "Names of labels, of --labels or of a network: LABEL NAME a line, or a "
                                     "table of ITK-SNAP, whose colours slices have",
                                     options.region_names);
}

void add_interface_options(const Command& command, InputOptions& options) {
  const Command input = command.in_group("Input");
  input.add_values("--interface", "FILE=FRONT,BACK",
                   "A surface (.obj, .off, .ply, .stl) between two materials, the first where its normals "
                   "point to; repeatable",
                   options.surfaces, parse_surface);
  add_region_names(command, options);
  input.add_value(
      "--box", "x0,x1,y0,y1,z0,z1",
      "The domain of given interfaces (default: that of the grid, else their own box, with 5% more "
      "along axes along which they do not end at its faces)",
      options.box, parse_box);
  input.add_value("--weld", "W|W%",
                  "Close gaps of given interfaces that are at most so wide: a length, or a part of the "
                  "domain's diagonal; 0 for none (default: 0.0001%)",
                  options.mending.gaps, parse_weld);
  input.add_flag("--tolerant",
                 "Take given interfaces that intersect, contradict each other or do not match, instead of "
                 "refusing them",
                 options.mending.tolerant);
}

void add_input_options(const Command& command, InputOptions& options, bool& smooth_labels,
                       FractionOptions& fractions) {
  add_material_options(command, options);
  command.in_group("Input").add_flag(
      "--stack", "INPUT is a pattern of pictures, one plane in each, as \"labels_*.tif\" (in quotes)",
      options.stack);
  command.in_group("Input").add_value("--time", "N",
                                      "Of a file of cells with several times (OpenFOAM, ExodusII, CGNS, "
                                      "Truchas): the number of one, from 0 on "
                                      "(default: the last one)",
                                      options.data.time, parse_count_from_0);
  add_raw_options(command, options.raw, "--origin,--first-sample", "a raw file or a stack");
  add_reconstruction_options(command, smooth_labels, fractions);
  add_interface_options(command, options);
}

bool names_materials(const InputOptions& options) {
  const MaterialDataOptions& data = options.data;
  return !data.fractions.empty() || !data.fraction_array.empty() || !data.labels.empty();
}

void share_raw_options(InputOptions& input, VolumeInput& volume) {
  if (names_materials(input) && !volume.stack) input.raw = std::exchange(volume.raw, {});
}

void share_time(const std::filesystem::path& path, InputOptions& input, VolumeInput& volume) {
  std::error_code unknown;
  if (!volume.time || volume.stack || !std::filesystem::is_regular_file(path, unknown)) return;
  if (!is_store(path) && input_kind(path) == InputKind::kCells)
    input.data.time = std::exchange(volume.time, {});
}

void protect_inputs(const InputOptions& options, const std::filesystem::path& base, OutputSet& outputs) {
  const auto protect = [&](const std::string& file) {
    if (file.empty()) return;
    outputs.protect(file);
    outputs.protect(base.parent_path() / file);
  };
  outputs.protect(options.path);
  outputs.protect(base);
  for (const auto& [name, file] : options.data.fractions) protect(file);
  for (const auto& [name, file] : options.data.fields) protect(file);
  for (const GivenSurface& surface : options.surfaces) outputs.protect(surface.file);
  protect(options.data.labels);
  protect(options.data.fraction_array);
  outputs.protect(options.region_names);
}

Input read_input(const InputOptions& options, const ReconstructOptions& reconstruction, Progress& progress) {
  check(reconstruction, options);
  return adamas::read_input(options, progress);
}

}  // namespace adamas::cli
