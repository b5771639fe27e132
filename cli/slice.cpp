#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/gradient_picture.h"
#include "cli/slice_request.h"
#include "cli/slice_series.h"
#include "cli/usage.h"
#include "cli/volume_options.h"
#include "core/base/loop_progress.h"
#include "core/io/input_file.h"
#include "core/io/unstructured_mesh_io.h"
#include "workflow/slices/slice_scale.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;
using namespace picture;
using namespace workflow;

namespace {

/// Prints the areas of the materials in the last section, which is the one with the fields of each material.
/// Samples without materials have none.
void report_areas(const SliceInput& input, const CrossSection& section, bool plain, Session& session,
                  Figures& figures) {
  figures["area"] = section.area;
  figures["materials"] = Figures::array();
  if (plain) return session.console.table({{"area", volume_text(section.area)}});
  std::vector<std::vector<std::string>> rows{{"material", "area", "part"}};
  for (MaterialId m(0); m.value < input.materials().size(); ++m.value) {
    const double area = m.value < section.material_area.size() ? section.material_area[m] : 0;
    figures["materials"].push_back({{"name", input.materials()[m]}, {"area", area}});
    if (area > 1e-9 * section.area && rows.size() <= 40) {
      rows.push_back(
          {input.materials()[m], volume_text(area), fmt::format("{:.3f}%", 100 * area / section.area)});
    }
  }
  session.console.table(rows);
}

/// Throws at options that make no sense, and at an output that cannot be written.
void check_options(const SliceRequest& request, OutputSet& outputs) {
  if (request.draw_cells && request.no_draw_cells)
    wrong_usage("--draw-cells and --no-draw-cells: expected one of them");
  static_cast<void>(value_range(request));
  const std::string main = with_main_file(request.input).path;
  protect_inputs(request.input, request.original.empty() ? main : request.original, outputs);
}

void run(SliceRequest& request, Session& session) {
  const LoopProgress loops(session.console);
  give_raw_options(request.volume, request.input);
  const SliceSteps steps = find_slice_steps(request, session);
  if (!request.inputs.empty()) request.input.path = request.inputs.front();
  Console& console = session.console;
  const Plane plane = parse_any_plane(request);
  const SliceOptions size = picture_size(request);
  check_options(request, session.outputs);
  std::optional<StepOfSeries> step;
  if (!steps.chosen.empty()) {
    if (request.step.empty() || names_series(request.output)) return slice_series(request, steps, session);
    const SliceStep& only = steps.chosen.front();
    session.outputs.protect(only.file);
    step = StepOfSeries{only.time, only.number};
    request.input.path = only.file;
    request.step.clear();
  }
  if (!request.frame_rate.empty()) wrong_usage("--frame-rate: expected a series, and a film as output");
  session.outputs.declare("-o", request.output, {".png", ".svg", ".pdf", ".vtp"});
  if (request.gradients) {
    if (is_store(request.input.path))
      static_cast<void>(sample_origin(request.input, request.volume, request.original));
    return draw_gradients({request.input.path, plane, request.output, size, request.step}, session);
  }
  const bool polygons = file_extension(request.output) == ".vtp";
  const CutInput cut = cut_input(request, polygons, session);
  Figures figures{{"area", nullptr}, {"materials", nullptr}, {"plane", to_string(plane)}};
  report_areas(cut.input, cut.sections.back(), cut.input.plain(), session, figures);
  figures["pieces"] = cut.sections.back().pieces.size();
  console.step("drawing", -1);
  session.outputs.write(request.output, [&](const auto& path) {
    if (polygons) return write_unstructured_mesh(path, section_polygons(cut));
    SlicePicture picture = make_picture(request, cut);
    if (const auto& of = step ? step : cut.input.step) add_step_title(of->time, of->number, picture);
    write_slice(picture, path, size);
  });
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, figures); });
  session.commit();
}

void add_drawing_options(const Command& command, SliceRequest& options) {
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
      .add_flag("--gradients", options.gradients,
                "Of a store with gradients: their directions as colours, -1 to 1 of x, y and z as red, green "
                "and blue; grey where there is none")
      .group("Picture");
  command.add_option("--range", options.range, "Values at the ends of the colour map")
      .type_name("a,b")
      .group("Picture");
  command.add_option("--colour-map,--color-map", options.colour_map, "The colour map (default sequential)")
      .one_of(ColourMap::names())
      .group("Picture");
  command.add_option("--size", options.size, "Width and greatest height in pixels")
      .type_name("W,H")
      .group("Picture");
}

}  // namespace

void add_slice(const Command& app, Session& session) {
  const auto options = std::make_shared<SliceRequest>();
  const Command command = add_command(
      app, session, "slice", "A cross section of data, of a mesh, of interfaces or of a stored volume",
      "adamas slice mesh.vtu --plane z=0 --field Pressure --mode all --original cth.vtr -o slice.png\n"
      "  adamas slice meshes.pvd --plane z=0 --field Pressure -o film.mp4",
      [options, &session] { run(*options, session); });
  command
      .add_option(
          "input", options->inputs,
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
          "--original", options->original,
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
      .add_option("--step", options->step,
                  "Of a series, one picture: the number of a step, from 0 on (of a stored one default 0)")
      .type_name("N");
  command.add_option("--steps", options->steps, "Of a series: all steps, or those from A to B")
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
  add_volume_options(command, options->volume, "--first-sample");
}

}  // namespace adamas::cli
