#include "cli/input_options.h"

#include <algorithm>
#include <array>

#include "cli/given_interfaces.h"
#include "cli/option_values.h"
#include "cli/usage_error.h"
#include "core/io/input_file.h"
#include "interfaces/grid_source.h"

namespace adamas {

namespace {

bool one_of(const std::string& text, std::initializer_list<const char*> list) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

CLI::Option* add_repeatable(CLI::App& command, const char* name, std::vector<std::string>& values,
                            const char* description) {
  return command.add_option(name, values, description)->allow_extra_args(false)->group("Input");
}

}  // namespace

InputKind input_kind(const std::string& path) {
  const std::string extension = file_extension(path);
  if (extension == ".vtu") return InputKind::kMesh;
  if (one_of(extension, {".vtp", ".arec", ".txt"})) return InputKind::kNetwork;
  if (one_of(extension, {".obj", ".off", ".ply", ".stl"})) return InputKind::kSurface;
  return InputKind::kGrid;
}

void add_material_options(CLI::App& command, InputOptions& options, const char* field,
                          const char* field_type) {
  add_repeatable(command, "--fraction", options.fractions,
                 "A material and where its volume fractions are; repeatable (default: all arrays named "
                 "\"Volume Fraction\")")
      ->type_name("NAME=FILE-or-ARRAY");
  command.add_option("--fraction-scale", options.fraction_scale, "What a volume fraction of 1 is stored as")
      ->type_name("S")
      ->group("Input");
  command.add_option("--rest", options.rest, "One more material, of what the others leave of 1")
      ->type_name("NAME")
      ->group("Input");
  command
      .add_option("--labels", options.labels, "Whole numbers that name the material of each cell or point")
      ->type_name("FILE-or-ARRAY")
      ->group("Input");
  add_repeatable(command, "--field", options.fields, field)->type_name(field_type);
  add_repeatable(command, "--extensive", options.extensive,
                 "A field of amounts per cell, to be divided by the material's volume there; repeatable")
      ->type_name("NAME");
  command.add_option("--region", options.region, "Keep what lies in this box")
      ->type_name("x0,x1,y0,y1,z0,z1")
      ->group("Input");
}

void add_interface_options(CLI::App& command, InputOptions& options) {
  add_repeatable(command, "--interface", options.interfaces,
                 "A surface (.obj, .off, .ply, .stl) between two materials, the first where its normals "
                 "point to; repeatable")
      ->type_name("FILE=FRONT,BACK");
  command
      .add_option("--region-names", options.region_names, "Names of a network's labels, LABEL NAME a line")
      ->type_name("FILE")
      ->group("Input");
  command
      .add_option(
          "--box", options.box,
          "The domain of given interfaces (default: that of the grid, else their own box and 5% more)")
      ->type_name("x0,x1,y0,y1,z0,z1")
      ->group("Input");
  command
      .add_flag("--tolerant", options.tolerant,
                "Take given interfaces that intersect or do not match, instead of refusing them")
      ->group("Input");
}

MaterialDataOptions material_options(const InputOptions& options) {
  MaterialDataOptions result;
  for (const std::string& text : options.fractions) {
    result.fractions.push_back(parse_assignment("--fraction", text));
  }
  for (const std::string& text : options.fields) {
    result.fields.push_back(parse_assignment("--field", text));
  }
  if (!options.fraction_scale.empty()) {
    result.fraction_scale = parse_positive("--fraction-scale", options.fraction_scale);
  }
  result.rest = options.rest;
  result.labels = options.labels;
  result.extensive = options.extensive;
  if (!options.region.empty()) result.region = parse_bounds("--region", options.region);
  return result;
}

MultiMaterialData load_data(const InputOptions& options, Console& console) {
  const MaterialDataOptions how = material_options(options);
  check_input_file(options.path);
  switch (input_kind(options.path)) {
    case InputKind::kGrid:
      return read_multi_material_data(options.path, how, console);
    case InputKind::kMesh:
      fail("{}: expected data on a grid, found a tetrahedral mesh", options.path);
    case InputKind::kNetwork:
      fail("{}: expected data on a grid, found interface meshes", options.path);
    case InputKind::kSurface:
      break;
  }
  fail("{}: expected data on a grid, found a surface (give it as --interface FILE=FRONT,BACK)", options.path);
}

void print_fraction_report(const MultiMaterialData& data, Console& console) {
  const FractionReport& r = data.report;
  if (r.negative == 0 && r.traces == 0 && r.renormalised == 0) return;
  console.print(
      "Volume fractions were mended: sums from {:.6g} to {:.6g}, {} sites scaled to 1, {} negative and "
      "{} traces set to 0\n",
      r.sum_min, r.sum_max, r.renormalised, r.negative, r.traces);
}

Input load_input(const InputOptions& options, Console& console) {
  Input input;
  if (has_given_interfaces(options)) {
    input.source = load_given_interfaces(options, input.data, console);
    return input;
  }
  if (options.path.empty()) wrong_usage("expected an INPUT or --interface, found neither");
  if (!options.box.empty()) wrong_usage("--box: expected given interfaces (for a grid, --region crops)");
  if (!options.region_names.empty()) wrong_usage("--region-names: expected a labelled network as INPUT");
  input.data = std::make_unique<MultiMaterialData>(load_data(options, console));
  input.source = make_grid_source(*input.data, console);
  return input;
}

}  // namespace adamas
