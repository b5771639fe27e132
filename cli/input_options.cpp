#include "cli/input_options.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "cli/figures.h"
#include "cli/given_interfaces.h"
#include "cli/option_values.h"
#include "cli/usage.h"
#include "core/io/array_file.h"
#include "core/io/input_file.h"
#include "interfaces/cross_section/field_choice.h"
#include "interfaces/library/input.h"
#include "interfaces/selection/saved_hierarchy_file.h"
#include "interfaces/source/grid_source.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;

namespace {

/// Says what was mended in volume fractions, unless it is round-off.
void note_mended_fractions(const MultiMaterialData& data, Console& console) {
  const FractionReport& r = data.report;
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
  console.note("{}: volume fractions were mended: {}", data.source, what);
}

/// Throws where --extensive names no field. Letter case counts as in all other options, although the reader
/// of the data ignores it.
void check_extensive(const InputOptions& options, const MultiMaterialData& data) {
  for (const std::string& name : options.extensive) {
    const auto same = [&name](const Field& field) { return field.name == name; };
    if (std::any_of(data.fields.begin(), data.fields.end(), same)) continue;
    std::string known;
    for (const Field& field : data.fields) known += (known.empty() ? "'" : ", '") + field.name + "'";
    fail("{}: --extensive: expected one of its fields ({}), found '{}'", data.source, known, name);
  }
}

CommandOption add_repeatable(const Command& command, const char* name, std::vector<std::string>& values,
                             const char* description) {
  return command.add_option(name, values, description).one_value_each().group("Input");
}

}  // namespace

bool InputOptions::names_materials() const {
  return !fractions.empty() || !fraction_array.empty() || !labels.empty();
}

std::string InputOptions::material_option() const {
  if (!fractions.empty()) return "--fraction";
  if (!fraction_array.empty()) return "--fractions";
  if (!fraction_scale.empty()) return "--fraction-scale";
  if (!rest.empty()) return "--rest";
  if (!labels.empty()) return "--labels";
  if (const std::string option = reconstruction_option(*this); !option.empty()) return option;
  if (!fields.empty()) return "--field";
  if (!extensive.empty()) return "--extensive";
  if (!region.empty()) return "--region";
  return raw.option();
}

std::string InputOptions::grid_option() const {
  if (const std::string option = material_option(); !option.empty()) return option;
  return cells ? "--cells" : points ? "--points" : "";
}

std::optional<Centering> InputOptions::centering() const {
  if (cells && points) wrong_usage("--cells and --points: expected one of them");
  if (cells) return Centering::kCells;
  return points ? std::optional(Centering::kPoints) : std::nullopt;
}

std::string InputOptions::interface_option() const {
  if (!region_names.empty()) return "--region-names";
  if (!box.empty()) return "--box";
  if (!weld.empty()) return "--weld";
  return tolerant ? "--tolerant" : "";
}

InputKind input_kind(const std::string& path) {
  if (is_saved_hierarchy(path)) return InputKind::kMesh;
  const InputKind kind = io::input_kind(std::filesystem::path(path));
  return kind == InputKind::kPolygons ? InputKind::kNetwork : kind;
}

std::string grid_files() {
  return fmt::format("data on a grid ({} and other images)", list_grid_endings(","));
}

void add_material_options(const Command& command, InputOptions& options, const char* field,
                          const char* field_type) {
  add_repeatable(command, "--fraction", options.fractions,
                 "A material and where its volume fractions are; repeatable (default: all arrays named "
                 "\"Volume Fraction\")")
      .type_name("NAME=FILE-or-ARRAY");
  command
      .add_option("--fractions", options.fraction_array,
                  "Where the volume fractions of several materials are, one in each component of an array or "
                  "at each time (default of their names: what the file calls its components, else ARRAY_1, "
                  "ARRAY_2, ...)")
      .type_name("[NAMES=]FILE-or-ARRAY")
      .group("Input");
  command.add_option("--fraction-scale", options.fraction_scale, "What a volume fraction of 1 is stored as")
      .type_name("S")
      .group("Input");
  command.add_option("--rest", options.rest, "One more material, of what the others leave of 1")
      .type_name("NAME")
      .group("Input");
  command.add_option("--labels", options.labels, "Whole numbers that name the material of each cell or point")
      .type_name("FILE-or-ARRAY")
      .group("Input");
  add_repeatable(command, "--field", options.fields, field).type_name(field_type);
  add_repeatable(command, "--extensive", options.extensive,
                 "A field of amounts per cell, to be divided by the material's volume there; repeatable")
      .type_name("NAME");
  command
      .add_flag("--cells", options.cells,
                "The values are of cells, whatever the file says (default, where it says nothing, for labels "
                "and volume fractions)")
      .group("Input");
  command.add_flag("--points", options.points, "The values are of points, whatever the file says")
      .group("Input");
  command.add_option("--region", options.region, "Keep what lies in this box")
      .type_name("x0,x1,y0,y1,z0,z1")
      .group("Input");
}

void add_reconstruction_options(const Command& command, InputOptions& options) {
  command
      .add_flag("--smooth-labels", options.smooth_labels,
                "Smooth the staircase of labels, within half a voxel along each axis; volumes stay")
      .group("Input");
  command
      .add_option(
          "--blur", options.blur,
          "How blurred volume fractions are: the standard deviation in cells, or none; auto, which is "
          "the default, reads it off them, place by place")
      .type_name("auto|none|S")
      .group("Input");
  command
      .add_option("--fraction-error", options.fraction_error,
                  "The standard deviation of errors of volume fractions, within which interfaces are smooth, "
                  "as 2%; auto, which is the default, reads it off them")
      .type_name("auto|P|P%")
      .group("Input");
  command
      .add_flag(
          "--keep-dispersed", options.keep_dispersed,
          "Draw islands round volume fractions that no interface explains, in place of counting them as "
          "dispersed volume")
      .group("Input");
}

namespace {

std::string fraction_option(const InputOptions& options) {
  if (!options.blur.empty()) return "--blur";
  if (!options.fraction_error.empty()) return "--fraction-error";
  return options.keep_dispersed ? "--keep-dispersed" : "";
}

FractionOptions fraction_options(const InputOptions& options) {
  FractionOptions fractions;
  fractions.keep_dispersed = options.keep_dispersed;
  if (!options.blur.empty() && options.blur != "auto")
    fractions.blur =
        options.blur == "none" ? 0 : parse_up_to("--blur", options.blur, FractionOptions::kMostBlur);
  if (!options.fraction_error.empty() && options.fraction_error != "auto")
    fractions.error = parse_part("--fraction-error", options.fraction_error, FractionOptions::kMostError);
  return fractions;
}

}  // namespace

std::string reconstruction_option(const InputOptions& options) {
  return options.smooth_labels ? "--smooth-labels" : fraction_option(options);
}

void refuse_reconstruction_options(const InputOptions& options) {
  refuse_reconstruction({options.smooth_labels, fraction_options(options)});
  // An option may be given that asks for the default.
  refuse_fraction_option(fraction_option(options));
}

ReconstructionOptions reconstruction_options(const InputOptions& options, const MultiMaterialData& data) {
  ReconstructionOptions result{.smooth_labels = options.smooth_labels,
                               .fractions = fraction_options(options)};
  check_reconstruction(result, data);
  check_fraction_option(fraction_option(options), data);
  return result;
}

void add_interface_options(const Command& command, InputOptions& options, bool resampled) {
  add_repeatable(command, "--interface", options.interfaces,
                 "A surface (.obj, .off, .ply, .stl) between two materials, the first where its normals "
                 "point to; repeatable")
      .type_name("FILE=FRONT,BACK");
  command.add_option("--region-names", options.region_names, "Names of a network's labels, LABEL NAME a line")
      .type_name("FILE")
      .group("Input");
  if (!resampled) return;
  command
      .add_option(
          "--box", options.box,
          "The domain of given interfaces (default: that of the grid, else their own box and 5% more)")
      .type_name("x0,x1,y0,y1,z0,z1")
      .group("Input");
  command
      .add_option(
          "--weld", options.weld,
          "Close gaps of given interfaces that are at most so wide: a length, or a part of the domain's "
          "diagonal; 0 for none (default: 0.0001%)")
      .type_name("W|W%")
      .group("Input");
  command
      .add_flag("--tolerant", options.tolerant,
                "Take given interfaces that intersect, contradict each other or do not match, instead of "
                "refusing them")
      .group("Input");
}

namespace {

/// The names of materials that --fractions gives, if any, and where their fractions are.
std::pair<std::vector<std::string>, std::string> fraction_array(const InputOptions& options) {
  const std::string& text = options.fraction_array;
  if (text.find('=') == std::string::npos) return {{}, text};
  const auto [names, file] = parse_assignment("--fractions", text);
  return {split_at_commas(names), file};
}

}  // namespace

void protect_inputs(const InputOptions& options, const std::string& base, OutputSet& outputs) {
  const auto protect = [&](const std::string& file) {
    if (file.empty()) return;
    outputs.protect(file);
    outputs.protect(std::filesystem::path(base).parent_path() / file);
  };
  const auto protect_value = [&](const std::string& text, std::size_t equals) {
    if (equals != std::string::npos) protect(text.substr(equals + 1));
  };
  outputs.protect(options.path);
  outputs.protect(base);
  for (const std::string& text : options.fractions) protect_value(text, text.find('='));
  for (const std::string& text : options.fields) protect_value(text, text.find('='));
  for (const std::string& text : options.interfaces) outputs.protect(text.substr(0, text.rfind('=')));
  protect(options.labels);
  protect(fraction_array(options).second);
  outputs.protect(options.region_names);
}

MaterialDataOptions material_options(const InputOptions& options) {
  MaterialDataOptions result;
  for (const std::string& text : options.fractions) {
    result.fractions.push_back(parse_assignment("--fraction", text));
  }
  for (const std::string& text : options.fields) {
    result.fields.push_back(parse_assignment("--field", text));
  }
  std::tie(result.fraction_names, result.fraction_array) = fraction_array(options);
  if (!options.fraction_scale.empty()) {
    result.fraction_scale = parse_positive("--fraction-scale", options.fraction_scale);
  }
  result.rest = options.rest;
  result.labels = options.labels;
  result.extensive = options.extensive;
  if (!options.region.empty()) result.region = parse_bounds("--region", options.region);
  result.centering = options.centering();
  result.plain = options.plain;
  return result;
}

std::string input_name(const InputOptions& options) {
  const std::size_t files = options.fractions.size();
  const bool first =
      files > 1 && parse_assignment("--fraction", options.fractions.front()).second == options.path;
  return first ? fmt::format("{} and {}", options.path, counted(files - 1, "more file")) : options.path;
}

InputOptions with_main_file(const InputOptions& options) {
  InputOptions result = options;
  if (!options.path.empty()) return result;
  if (!options.fractions.empty())
    result.path = parse_assignment("--fraction", options.fractions.front()).second;
  else if (!options.fraction_array.empty())
    result.path = fraction_array(options).second;
  else if (!options.labels.empty())
    result.path = options.labels;
  return result;
}

InputOptions with_needed_main_file(const InputOptions& options, const char* expected) {
  InputOptions result = with_main_file(options);
  if (result.path.empty())
    wrong_usage("expected {}, or files in --fraction, --fractions or --labels, found neither", expected);
  return result;
}

MultiMaterialData load_data(const InputOptions& given, Console& console) {
  fraction_options(given);  // Wrong ones are told before anything is read.
  const InputOptions options = with_needed_main_file(given);
  MaterialDataOptions how = material_options(options);
  how.note = [&console](const std::string& text) { console.note("{}", text); };
  const std::optional<RawVolume> raw = raw_volume(options.raw);
  if (const std::string option = options.raw.option(); !raw && !option.empty())
    wrong_usage("{}: expected --dimensions as well", option);
  check_input_file(options.path);
  switch (input_kind(options.path)) {
    case InputKind::kMesh:
      fail("{}: expected data on a grid, found a tetrahedral mesh", options.path);
    case InputKind::kPolygons:
    case InputKind::kNetwork:
      fail("{}: expected data on a grid, found interface meshes", options.path);
    case InputKind::kSurface:
      fail("{}: expected data on a grid, found a surface (give it as --interface FILE=FRONT,BACK)",
           options.path);
    case InputKind::kGrid:
      break;
  }
  MultiMaterialData data = read_multi_material_data(options.path, how, console, raw);
  data.source = input_name(options);
  check_extensive(options, data);
  note_mended_fractions(data, console);
  return data;
}

LoadedInput load_input(const InputOptions& given, Console& console, const InputCheck& check) {
  const InputOptions options = with_main_file(given);
  LoadedInput input;
  if (has_given_interfaces(options)) {
    refuse_reconstruction_options(options);
    input.source = load_given_interfaces(options, input.data, console, check);
    return input;
  }
  if (options.path.empty())
    wrong_usage(
        "expected an INPUT, --interface, or files in --fraction, --fractions or --labels, found none");
  if (!options.box.empty()) wrong_usage("--box: expected given interfaces (for a grid, --region crops)");
  if (!options.region_names.empty()) wrong_usage("--region-names: expected a labelled network as INPUT");
  if (!options.weld.empty() || options.tolerant)
    wrong_usage("{}: expected given interfaces", options.tolerant ? "--tolerant" : "--weld");
  input.data = std::make_unique<MultiMaterialData>(load_data(options, console));
  if (check)
    check({options.path, input.data->grid.domain(), field_infos(*input.data),
           input.data->grid.least_spacing()});
  input.source = make_grid_source(*input.data, reconstruction_options(options, *input.data), console);
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

bool is_saved_hierarchy(const std::string& path) {
  return file_extension(path) == ".h5" && is_array_file(path, kHierarchyFormat);
}

SavedHierarchy load_saved_hierarchy(const std::string& path, Console& console) {
  check_input_file(path);
  console.step("reading " + path, -1);
  const ArrayFile file =
      read_array_file(path, kHierarchyFormat, names_of_arrays(), kOldestHierarchyVersion, kHierarchyVersion);
  return from_arrays(file.arrays, path, file.version);
}

}  // namespace adamas::cli
