#include "cli/input_options.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "adamas/volume_input.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

CommandOption add_repeatable(const Command& command, const char* name, std::vector<std::string>& values,
                             const char* description) {
  return command.add_option(name, values, description).one_value_each().group("Input");
}

}  // namespace

bool InputArguments::names_materials() const {
  return !fractions.empty() || !fraction_array.empty() || !labels.empty();
}

std::string InputArguments::material_option() const {
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

std::string InputArguments::grid_option() const {
  if (const std::string option = material_option(); !option.empty()) return option;
  return cells ? "--cells" : points ? "--points" : "";
}

std::optional<Centering> InputArguments::centering() const {
  if (cells && points) wrong_usage("--cells and --points: expected one of them");
  if (cells) return Centering::kCells;
  return points ? std::optional(Centering::kPoints) : std::nullopt;
}

std::string InputArguments::interface_option() const {
  if (!region_names.empty()) return "--region-names";
  if (!box.empty()) return "--box";
  if (!weld.empty()) return "--weld";
  return tolerant ? "--tolerant" : "";
}

std::string grid_files() { return fmt::format("data on a grid ({} and other images)", grid_endings()); }

void add_material_options(const Command& command, InputArguments& options, const char* field,
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

void add_reconstruction_options(const Command& command, InputArguments& options) {
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

std::string fraction_option(const InputArguments& options) {
  if (!options.blur.empty()) return "--blur";
  if (!options.fraction_error.empty()) return "--fraction-error";
  return options.keep_dispersed ? "--keep-dispersed" : "";
}

FractionOptions fraction_options(const InputArguments& options) {
  FractionOptions fractions;
  fractions.keep_dispersed = options.keep_dispersed;
  if (!options.blur.empty() && options.blur != "auto")
    fractions.blur =
        options.blur == "none" ? 0 : parse_up_to("--blur", options.blur, FractionOptions::kMostBlur);
  if (!options.fraction_error.empty() && options.fraction_error != "auto")
    fractions.error = parse_part("--fraction-error", options.fraction_error, FractionOptions::kMostError);
  return fractions;
}

std::string reconstruction_option(const InputArguments& options) {
  return options.smooth_labels ? "--smooth-labels" : fraction_option(options);
}

void refuse_reconstruction_options(const InputArguments& options) {
  if (const std::string option = reconstruction_option(options); !option.empty())
    wrong_usage("{}: expected {} as INPUT, found given interfaces", option,
                options.smooth_labels ? "labels" : "volume fractions");
}

void check_fraction_options(const InputArguments& options, const Input& input, const std::string& source) {
  const std::string option = fraction_option(options);
  if (!option.empty() && input.has_labels())
    wrong_usage("{}: expected volume fractions, found labels in {}", option, source);
}

void add_interface_options(const Command& command, InputArguments& options, bool resampled) {
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

/// Returns the material names of --fractions, if any, and the array with their fractions.
std::pair<std::vector<std::string>, std::string> fraction_array(const InputArguments& options) {
  const std::string& text = options.fraction_array;
  if (text.find('=') == std::string::npos) return {{}, text};
  const auto [names, file] = parse_assignment("--fractions", text);
  return {split_at_commas(names), file};
}

}  // namespace

void protect_inputs(const InputArguments& options, const std::string& base, OutputSet& outputs) {
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

namespace {

MaterialDataOptions material_options(const InputArguments& options) {
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

GivenSurface parse_surface(const std::string& text) {
  const auto [file, pair] = parse_assignment("--interface", text, true);
  const std::size_t comma = pair.find(',');
  const std::string front = pair.substr(0, comma);
  const std::string back = comma == std::string::npos ? "" : pair.substr(comma + 1);
  if (front.empty() || back.empty() || front == back) {
    wrong_usage("--interface: expected FILE=FRONT,BACK with two materials, found '{}'", text);
  }
  return {file, front, back};
}

/// Returns the greatest width of the gaps that are closed.
ErrorTarget parse_weld(const std::string& text) {
  if (text.empty()) return MendingOptions().gaps;
  if (text == "0") return {};
  return parse_error_target("--weld", text);
}

}  // namespace

InputOptions to_input_options(const InputArguments& options) {
  fraction_options(options);
  InputOptions result;
  result.path = options.path;
  result.data = material_options(options);
  result.raw = raw_volume(options.raw);
  if (const std::string option = options.raw.option(); !result.raw && !option.empty())
    wrong_usage("{}: expected --dimensions as well", option);
  for (const std::string& text : options.interfaces) result.surfaces.push_back(parse_surface(text));
  result.region_names = options.region_names;
  if (!options.box.empty()) result.box = to_box(parse_bounds("--box", options.box));
  result.mending = {parse_weld(options.weld), options.tolerant};
  return result;
}

InputArguments with_main_file(const InputArguments& options) {
  InputArguments result = options;
  if (!options.path.empty()) return result;
  if (!options.fractions.empty())
    result.path = parse_assignment("--fraction", options.fractions.front()).second;
  else if (!options.fraction_array.empty())
    result.path = fraction_array(options).second;
  else if (!options.labels.empty())
    result.path = options.labels;
  return result;
}

InputArguments with_needed_main_file(const InputArguments& options, const char* expected) {
  InputArguments result = with_main_file(options);
  if (result.path.empty())
    wrong_usage("expected {}, or files in --fraction, --fractions or --labels, found neither", expected);
  return result;
}

Input read_input(const InputArguments& given, Progress& progress) {
  const InputArguments options = with_main_file(given);
  const InputOptions from = to_input_options(options);
  if (adamas::has_given_interfaces(from)) refuse_reconstruction_options(options);
  return adamas::read_input(from, progress);
}

bool has_given_interfaces(const InputArguments& options) {
  return adamas::has_given_interfaces(to_input_options(options));
}

}  // namespace adamas::cli
