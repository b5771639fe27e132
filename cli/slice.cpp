#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "adamas/notes.h"
#include "adamas/picture.h"
#include "adamas/slice_files.h"
#include "adamas/text.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/option_values.h"
#include "cli/usage.h"
#include "cli/volume_options.h"

namespace adamas::cli {

namespace {

/// The options of `slice`, as they were given.
struct SliceArguments {
  SliceRequest request;  ///< the options that have types
  InputArguments input;
  std::string plane, origin, normal, mode, range, size, frame_rate, output;
  bool draw_cells = false, no_draw_cells = false, no_interfaces = false;
};

/// Splits the values of --field: `NAME=FILE` adds a field as for other commands. Returns the last one named,
/// which is shown.
std::string split_fields(InputArguments& input) {
  std::string shown;
  std::vector<std::string> added;
  for (const std::string& text : input.fields) {
    if (text.find('=') != std::string::npos) added.push_back(text);
    shown = text.substr(0, text.find('='));
  }
  input.fields = added;
  return shown;
}

/// Returns the plane of --plane, or of --origin and --normal. Throws Error (kUsage).
Plane parse_any_plane(const SliceArguments& options) {
  if (options.plane.empty() == (options.origin.empty() && options.normal.empty()))
    wrong_usage("expected --plane, or --origin and --normal");
  if (!options.plane.empty()) return parse_plane_option("--plane", options.plane);
  if (options.origin.empty() || options.normal.empty())
    wrong_usage("expected --origin and --normal together");
  return parse_plane_at(options.origin, options.normal);
}

void parse_picture_size(const std::string& text, SliceRequest& request) {
  if (text.empty()) return;
  const auto sides = parse_numbers("--size", text, 2);
  for (const double side : sides) {
    if (!(side >= 200 && side <= 16000))
      wrong_usage("--size: expected a width and a height from 200 to 16000, found '{}'", text);
  }
  request.width = sides[0];
  request.greatest_height = sides[1];
}

SliceSections parse_sections(const std::string& mode) {
  if (mode.empty()) return SliceSections::kDefault;
  if (mode == "input") return SliceSections::kInput;
  if (mode == "plain") return SliceSections::kPlain;
  return mode == "all" ? SliceSections::kAll : SliceSections::kMaterials;
}

/// Returns the request to the library. Throws Error (kUsage) for invalid values.
SliceRequest to_slice_request(const SliceArguments& options) {
  SliceRequest request = options.request;
  InputArguments input = options.input;
  // Bare samples with volume fractions or labels are data on a grid.
  if (input.names_materials() && !request.volume.stack) input.raw = std::exchange(request.volume.raw, {});
  request.plane = parse_any_plane(options);
  parse_picture_size(options.size, request);
  if (options.draw_cells && options.no_draw_cells)
    wrong_usage("--draw-cells and --no-draw-cells: expected one of them");
  if (!options.range.empty()) request.range = parse_range(options.range);
  request.material_option = input.material_option();
  request.field = split_fields(input);
  // Data without materials are accepted unless an option is about materials.
  input.plain = input.material_option().empty() && request.original.empty();
  request.input = to_input_options(input);
  if (!reconstruction_option(input).empty() && adamas::has_given_interfaces(request.input))
    refuse_reconstruction_options(input);
  request.smooth_labels = input.smooth_labels;
  request.fractions = fraction_options(input);
  request.fraction_option = fraction_option(input);
  request.sections = parse_sections(options.mode);
  if (options.draw_cells || options.no_draw_cells) request.cells = options.draw_cells;
  request.interfaces = !options.no_interfaces;
  if (!options.frame_rate.empty()) request.frame_rate = parse_positive("--frame-rate", options.frame_rate);
  return request;
}

Figures material_figures(const SliceAreas& areas) {
  Figures figures = Figures::array();
  for (const auto& [name, area] : areas.materials) figures.push_back({{"name", name}, {"area", area}});
  return figures;
}

/// Prints the areas of the materials in the last section, which is the one with the fields of each material.
/// Samples without materials have none.
void report_areas(const SliceAreas& areas, const std::string& plane, Session& session, Figures& figures) {
  figures["area"] = areas.area;
  figures["materials"] = material_figures(areas);
  figures["plane"] = plane;
  figures["pieces"] = areas.pieces;
  if (areas.plain) return session.console.table({{"area", volume_text(areas.area)}});
  std::vector<std::vector<std::string>> rows{{"material", "area", "part"}};
  for (const auto& [name, area] : areas.materials) {
    if (area > 1e-9 * areas.area && rows.size() <= 40)
      rows.push_back({name, volume_text(area), fmt::format("{:.3f}%", 100 * area / areas.area)});
  }
  session.console.table(rows);
}

/// Prints the number of steps of a series that were drawn, and the range of their values.
Figures report_series(const SliceReport& report, const std::string& plane, Session& session) {
  Figures rows = Figures::array();
  for (const SlicedStep& step : report.steps)
    rows.push_back({{"step", step.number},
                    {"time", step.time},
                    {"file", step.file},
                    {"area", step.areas.area},
                    {"materials", material_figures(step.areas)},
                    {"pieces", step.areas.pieces}});
  Figures figures{{"plane", plane},
                  {"range", nullptr},
                  {"steps", std::move(rows)},
                  {"damaged_steps", report.damaged_steps}};
  const auto& range = report.range;
  if (range) figures["range"] = *range;
  session.console.print("  {}{}\n", counted(report.steps.size(), "step"),
                        range ? fmt::format(", values from {:.6g} to {:.6g}", (*range)[0], (*range)[1]) : "");
  return figures;
}

void run(const SliceArguments& options, Session& session) {
  const SliceRequest request = to_slice_request(options);
  protect_inputs(options.input,
                 request.original.empty() ? with_main_file(options.input).path : request.original,
                 session.outputs);
  const SliceReport report = write_slice(request, options.output, session.outputs, session.console);
  const std::string plane = to_string(request.plane);
  Figures figures;
  if (report.is_series) {
    figures = report_series(report, plane, session);
  } else if (report.part_without_gradient) {
    const double part = *report.part_without_gradient;
    session.console.table({{"pixels without a gradient", fmt::format("{:.2f}%", 100 * part)}});
    figures["plane"] = plane;
    figures["part_without_gradient"] = part;
  } else {
    report_areas(*report.areas, plane, session, figures);
  }
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  session.commit();
  note_several(report.damages, {"step", "steps"}, session.console, NoteKind::kIncomplete);
}

void add_drawing_options(const Command& command, SliceArguments& options) {
  command
      .add_option(
          "--mode", options.mode,
          "The input as it is, or of a mesh: plain linear interpolation, the fields of each material, "
          "all side by side (default: input for data, materials for a mesh)")
      .one_of({"input", "plain", "materials", "all"})
      .group("Picture");
  command
      .add_flag("--draw-cells", options.draw_cells,
                "Draw the cells (default for a mesh, and for its input unless they are tiny)")
      .group("Picture");
  command.add_flag("--no-draw-cells", options.no_draw_cells, "Do not draw the cells").group("Picture");
  command.add_flag("--no-interfaces", options.no_interfaces, "Do not draw the interfaces").group("Picture");
  command
      .add_flag("--gradients", options.request.gradients,
                "Of a store with gradients: their directions as colours, -1 to 1 of x, y and z as red, green "
                "and blue; grey where there is none")
      .group("Picture");
  command.add_option("--range", options.range, "Values at the ends of the colour map")
      .type_name("a,b")
      .group("Picture");
  command
      .add_option("--colour-map,--color-map", options.request.colour_map,
                  "The colour map (default sequential)")
      .one_of(colour_map_names())
      .group("Picture");
  command.add_option("--size", options.size, "Width and greatest height in pixels")
      .type_name("W,H")
      .group("Picture");
}

}  // namespace

void add_slice(const Command& app, Session& session) {
  const auto options = std::make_shared<SliceArguments>();
  const Command command = add_command(
      app, session, "slice", "A cross section of data, of a mesh, of interfaces or of a stored volume",
      "adamas slice mesh.vtu --plane z=0 --field Pressure --mode all --original cth.vtr -o slice.png\n"
      "  adamas slice meshes.pvd --plane z=0 --field Pressure -o film.mp4",
      [options, &session] { run(*options, session); });
  command
      .add_option(
          "input", options->request.inputs,
          "What to cut: " + grid_files() +
              ", a mesh from adamas resample (.vtu), interfaces (.vtp, .ply, .arec, .txt), or a store from "
              "adamas store (.adm). Or a series of data or meshes: a .pvd, several files, or a pattern of "
              "their names in quotes, as \"run_%04d.vti\". A stored series and a file with several times are "
              "series too where several pictures are asked for")
      .type_name("FILE...");
  command.add_option("--plane", options->plane, "The plane, at right angles to an axis")
      .type_name("x=N|y=N|z=N");
  command.add_option("--origin", options->origin, "A point of the plane").type_name("x,y,z");
  command.add_option("--normal", options->normal, "A vector at right angles to it").type_name("x,y,z");
  command
      .add_option(
          "--original", options->request.original,
          "What a mesh was resampled from: data on a grid, or a labelled network; of a series of meshes a "
          "series, or one for all")
      .type_name("FILE");
  command
      .add_option(
          "-o,--output", options->output,
          "A picture (.png, .svg, .pdf) or polygons (.vtp). Of a series a film (.mp4, .webm, .gif; by "
          "ffmpeg), a pattern of pictures as S_%04d.png, or a list of polygons (.pvd)")
      .required()
      .type_name("FILE");
  command
      .add_converted("--step",
                     "Of a series, one picture: the number of a step, from 0 on (of a stored one default 0)",
                     [options](const std::string& option, const std::string& text) {
                       options->request.step = parse_count(option, text, 0);
                     })
      .type_name("N");
  command.add_option("--steps", options->request.steps, "Of a series: all steps, or those from A to B")
      .type_name("A,B");
  command.add_option("--frame-rate", options->frame_rate, "Steps of a film per second (default 10)")
      .type_name("N");
  add_drawing_options(command, *options);
  add_material_options(command, options->input,
                       "The field to show, or NAME:x for a component of a vector; without, the materials. "
                       "NAME=FILE adds it first",
                       "NAME[=FILE-or-ARRAY]");
  add_reconstruction_options(command, options->input);
  add_interface_options(command, options->input);
  add_volume_options(command, options->request.volume, "--first-sample");
}

}  // namespace adamas::cli
