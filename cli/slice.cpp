#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adamas/picture.h"
#include "adamas/slice_files.h"
#include "adamas/text.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/option_values.h"
#include "cli/series_figures.h"
#include "cli/usage.h"
#include "cli/volume_options.h"

namespace adamas::cli {

namespace {

/// The options of `slice`.
struct Options {
  SliceRequest request;
  std::optional<Plane> plane;
  std::optional<Vec3> origin, normal;
  std::string steps, output;
  bool draw_cells = false, no_draw_cells = false, no_interfaces = false;
};

/// The plane that --plane, or --origin and --normal, name. Throws Error (kUsage).
Plane wanted_plane(const Options& options) {
  if (options.plane.has_value() == (options.origin || options.normal))
    wrong_usage("expected --plane, or --origin and --normal");
  if (options.plane) return *options.plane;
  if (!options.origin || !options.normal) wrong_usage("expected --origin and --normal together");
  return {*options.origin, *options.normal};
}

/// What the options ask of the library. Throws Error (kUsage) for those that do not go together.
SliceRequest to_slice_request(const Options& options) {
  SliceRequest request = options.request;
  share_raw_options(request.input, request.volume);
  if (request.inputs.size() == 1) share_time(request.inputs[0], request.input, request.volume);
  request.plane = wanted_plane(options);
  if (options.draw_cells && options.no_draw_cells)
    wrong_usage("--draw-cells and --no-draw-cells: expected one of them");
  if (options.draw_cells || options.no_draw_cells) request.cells = options.draw_cells;
  request.interfaces = !options.no_interfaces;
  if (!options.steps.empty())
    request.steps = parse_steps(
        options.steps, [&request] { return slice_steps(request).size(); },
        request.inputs.empty() ? "" : request.inputs[0]);
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
                  {"range", figure(report.range)},
                  {"steps", std::move(rows)},
                  {"damaged_steps", damaged_steps(report.left_out)}};
  const auto& range = report.range;
  session.console.print("  {}{}\n", counted(report.steps.size(), "step"),
                        range ? fmt::format(", values from {:.6g} to {:.6g}", (*range)[0], (*range)[1]) : "");
  return figures;
}

void run(const Options& options, Session& session) {
  const SliceRequest request = to_slice_request(options);
  protect_inputs(
      request.input,
      request.original.empty() ? with_main_file(request.input).path : std::filesystem::path(request.original),
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
  write_figures(figures, session);
  session.commit();
  note_left_out(report.left_out, session.console);
}

void add_plane_options(const Command& command, Options& options) {
  command.add_value("--plane", "x=N|y=N|z=N", "The plane, at right angles to an axis", options.plane,
                    parse_plane_option);
  command.add_value("--origin", "x,y,z", "A point of the plane", options.origin, parse_vector);
  command.add_value("--normal", "x,y,z", "A vector at right angles to it", options.normal, parse_vector);
}

void add_step_options(const Command& command, Options& options) {
  command.add_value("--step", "N",
                    "Of a series, one picture: the number of a step, from 0 on (of a stored one default 0)",
                    options.request.step, parse_count_from_0);
  command.add_option("--steps", "A,B", "Of a series: all steps, or those from A to B", options.steps);
  command.add_value("--frame-rate", "N", "Steps of a film per second (default 10)",
                    options.request.frame_rate, parse_number);
}

void add_drawing_options(const Command& command, Options& options) {
  SliceRequest& request = options.request;
  const Command picture = command.in_group("Picture");
  picture.add_choice<SliceSections>(
      "--mode",
      "The input as it is, or of a mesh: plain linear interpolation, the fields of each material, all side "
      "by side (default: input for data, materials for a mesh)",
      request.sections,
      {{"input", SliceSections::kInput},
       {"plain", SliceSections::kPlain},
       {"materials", SliceSections::kMaterials},
       {"all", SliceSections::kAll}});
  picture.add_flag("--draw-cells",
                   "Draw the cells (default for a mesh, and for its input unless they are tiny)",
                   options.draw_cells);
  picture.add_flag("--no-draw-cells", "Do not draw the cells", options.no_draw_cells);
  picture.add_flag("--no-interfaces", "Do not draw the interfaces", options.no_interfaces);
  picture.add_flag("--gradients",
                   "Of a store with gradients: their directions as colours, -1 to 1 of x, y and z as red, "
                   "green and blue; grey where there is none",
                   request.gradients);
  picture.add_value("--range", "a,b", "Values at the ends of the colour map", request.range,
                    parse_two_numbers);
  picture
      .add_option("--colour-map,--color-map", {}, "The colour map (default sequential)", request.colour_map)
      .one_of(colour_map_names());
  picture.add_converted("--size", "W,H", "Width and greatest height in pixels",
                        [&request](const std::string& option, const std::string& text) {
                          const auto [width, height] = parse_two_numbers(option, text);
                          request.width = width;
                          request.greatest_height = height;
                        });
}

/// `--field NAME=FILE` adds a field as for other commands; the last one named is shown.
void take_field(const std::string& option, const std::string& text, SliceRequest& request) {
  request.field = text.substr(0, text.find('='));
  if (request.field != text) request.input.data.fields.push_back(parse_assignment(option, text));
}

}  // namespace

void add_slice(const Command& app, Session& session) {
  const auto [command, options] = add_command(
      app, session, "slice", "A cross section of data, of a mesh, of interfaces or of a stored volume",
      "adamas slice mesh.vtu --plane z=0 --field Pressure --mode all --original cth.vtr -o slice.png\n"
      "  adamas slice meshes.pvd --plane z=0 --field Pressure -o film.mp4",
      run);
  SliceRequest& request = options.request;
  command.add_option(
      "input", "FILE...",
      "What to cut: " + grid_files() + ", the materials of " + mesh_files() +
          ", a mesh from adamas resample (.vtu), interfaces (.vtp, .ply, .arec, .txt), or a store from "
          "adamas store (.adm). Or a series of data or meshes: a .pvd, several files, or a pattern of "
          "their names in quotes, as \"run_%04d.vti\". A stored series and a file with several times are "
          "series too where several pictures are asked for",
      request.inputs);
  add_plane_options(command, options);
  command.add_option("--original", "FILE",
                     "What a mesh was resampled from: data on a grid, or a labelled network; of a series of "
                     "meshes a series, or one for all",
                     request.original);
  command
      .add_option(
          "-o,--output", "FILE",
          "A picture (.png, .svg, .pdf) or polygons (.vtp). Of a series a film (.mp4, .webm, .gif; by "
          "ffmpeg), a pattern of pictures as S_%04d.png, or a list of polygons (.pvd)",
          options.output)
      .required();
  add_step_options(command, options);
  add_drawing_options(command, options);
  add_material_options(
      command, request.input, "NAME[=FILE-or-ARRAY]",
      "The field to show, or NAME:x for a component of a vector; without, the materials. "
      "NAME=FILE adds it first",
      [&request](const std::string& option, const std::string& text) { take_field(option, text, request); });
  add_reconstruction_options(command, request.smooth_labels, request.fractions);
  add_interface_options(command, request.input);
  add_volume_options(command, request.volume, "--first-sample");
}

}  // namespace adamas::cli
