#include "adamas/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "adamas/picture.h"
#include "adamas/play.h"
#include "adamas/volume_store.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/store_options.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

/// The options of `adamas view`.
struct Options {
  std::vector<std::string> files;
  std::string steps;  ///< the text of --steps, whose check needs the files; empty where it was not given
  std::optional<Vec3> origin, normal;
  bool offscreen = false, no_cut = false, no_section = false;
  ViewOptions view;
  FlightOptions flight;
};

/// Throws Error (kUsage) for options that have no effect.
void check_use(const Options& options, const Session& session) {
  const FlightOptions& flight = options.flight;
  if (options.offscreen) {
    if (flight.frames.empty() && flight.film.empty() && session.json.empty())
      wrong_usage("expected --frames, --film or --json, found no output");
    return;
  }
  const bool has_path = flight.camera_path || flight.along_bookmarks;
  const char* unused = !flight.frames.empty()   ? "--frames"
                       : !flight.film.empty()   ? "--film"
                       : flight.frame_rate      ? "--frame-rate"
                       : !options.steps.empty() ? "--steps"
                       : !session.json.empty()  ? "--json"
                       : has_path               ? "--camera-path"
                                                : nullptr;
  if (unused != nullptr) wrong_usage("{}: expected --offscreen as well: a window writes no frames", unused);
}

/// Returns the number of steps of the longest series among the files. Throws Error (kUsage) where there is no
/// series.
std::size_t longest_series(const std::vector<std::string>& files) {
  std::uint32_t steps = 0;
  for (const std::string& file : files) {
    if (is_store(file)) steps = std::max(steps, stored_steps(file));
  }
  if (steps < 2) wrong_usage("--steps: expected a stored series, found none");
  return steps;
}

/// Completes the options of the library by those whose meaning depends on others.
void complete(Options& options) {
  ViewOptions& view = options.view;
  FlightOptions& flight = options.flight;
  view.files.assign(options.files.begin(), options.files.end());
  if (!view.plane && options.origin.has_value() != options.normal.has_value())
    wrong_usage("expected both --origin and --normal");
  if (!view.plane && options.origin) view.plane = Plane{*options.origin, *options.normal};
  view.cuts_away = !options.no_cut;
  view.shows_section = !options.no_section;
  if (options.offscreen && !options.steps.empty())
    flight.steps = parse_steps(
        options.steps, [&options] { return longest_series(options.files); }, "the series");
}

void take_camera_path(const std::string& text, FlightOptions& flight) {
  flight.along_bookmarks = text == "bookmarks";
  if (!flight.along_bookmarks) flight.camera_path = parse_camera_path(text);
}

/// Parses two whole numbers; the library checks whether pictures can have such sides.
std::array<int, 2> parse_pixels(const std::string& option, const std::string& text) {
  constexpr double kMost = 1e9;
  const auto sides = parse_two_numbers(option, text);
  for (const double side : sides) {
    if (std::abs(side) > kMost || side != std::floor(side))
      wrong_usage("{}: expected two whole numbers W,H, found '{}'", option, text);
  }
  return {static_cast<int>(sides[0]), static_cast<int>(sides[1])};
}

Figures frame_figures(const FlightReport& flown) {
  Figures frames = Figures::array();
  for (const ViewedFrame& frame : flown.frames) {
    if (frame.problem.empty()) {
      frames.push_back({{"triangles", frame.triangles},
                        {"splits", frame.splits},
                        {"merges", frame.merges},
                        {"occluded_diamonds", frame.occluded_diamonds},
                        {"occlusion_queries", frame.occlusion_queries},
                        {"largest_error_pixels", frame.largest_error_pixels},
                        {"pages_missing", frame.pages_missing},
                        {"pages_lost", frame.pages_lost},
                        {"rendered_triangles", frame.rendered_triangles},
                        {"draw_calls", frame.draw_calls},
                        {"copied_bytes", frame.copied_bytes},
                        {"update_seconds", frame.update_seconds},
                        {"draw_seconds", frame.draw_seconds}});
    } else {
      frames.push_back({{"problem", frame.problem}});
    }
    if (!frame.step) continue;
    frames.back()["step"] = *frame.step;
    frames.back()["time"] = frame.time;
  }
  return frames;
}

Figures figures_of(const FlightReport& flown) {
  return {{"drawn_by", flown.drawn_by},          {"frames", frame_figures(flown)},
          {"pages_read", flown.pages},           {"pages_read_as_predictors", flown.predictor_pages},
          {"bytes_read", flown.bytes},           {"pages_from_copies", flown.copied_pages},
          {"damaged_pages", flown.damaged_pages}};
}

void print(const FlightReport& flown, Console& console) {
  std::size_t drawn = 0;
  std::uint64_t most_triangles = 0;
  double seconds = 0, largest_error = 0;
  for (const ViewedFrame& frame : flown.frames) {
    if (!frame.problem.empty()) continue;
    ++drawn;
    seconds += frame.update_seconds + frame.draw_seconds;
    largest_error = std::max(largest_error, frame.largest_error_pixels);
    most_triangles = std::max(most_triangles, frame.triangles);
  }
  console.table({{"frames", std::to_string(drawn)},
                 {"most triangles", std::to_string(most_triangles)},
                 {"largest error", fmt::format("{:.3g} pixels (estimate)", largest_error)},
                 {"seconds a frame", fmt::format("{:.3f}", seconds / static_cast<double>(drawn))},
                 {"drawn by", flown.drawn_by}});
}

void run_offscreen(const Options& options, Session& session) {
  OffscreenFlight flight(options.view, options.flight, session.outputs, session.console);
  const FlightReport flown = flight.draw(session.console);
  print(flown, session.console);
  Figures figures = figures_of(flown);
  add_costs(figures, session.console);
  write_figures(figures, session);
  flight.finish();
  session.console.flush();
  flight.commit();
  session.commit();
}

void run(Options& options, Session& session) {
  check_use(options, session);
  complete(options);
  if (options.offscreen) return run_offscreen(options, session);
  // Messages name the first of these files; OffscreenFlight sees to that itself.
  for (const std::string& file : options.files) session.outputs.protect(file);
  ViewWindow window(options.view, session.console);
  session.console.clear();
  window.show(session.console);
}

/// Adds the options that say what pictures show of stores.
void add_surface_options(const Command& command, ViewOptions& view) {
  command.add_values(
      "--isovalue", "V",
      "The value of a store's surface; repeatable (default: the one that parts the samples best in two)",
      view.isovalues, parse_number);
  command.add_values("--opacity", "0..1", "Of the surface of the same place among --isovalue", view.opacities,
                     parse_number);
  command.add_file("--colour-by,--color-by", "FILE", "Another store, whose values colour surfaces",
                   view.colour_by);
  command.add_option("--field", "NAME", "The field that colours show, NAME or NAME:x of a vector",
                     view.field);
  command.add_value("--range", "a,b",
                    "The values at the ends of the colour map, of the field or of a store's section",
                    view.range, parse_two_numbers);
  command.add_option("--colour-map,--color-map", {}, "The colour map (default sequential)", view.colour_map)
      .one_of(colour_map_names());
  command.add_option("--hide", "NAME", "A material that is not shown; repeatable", view.hidden)
      .one_value_each();
}

/// Adds the options of the cutting plane and of the appearance.
void add_look_options(const Command& command, Options& options) {
  ViewOptions& view = options.view;
  command.add_value("--plane", "x=N|y=N|z=N", "A plane that cuts, at right angles to an axis", view.plane,
                    parse_plane_option);
  command.add_value("--origin", "x,y,z", "A point of the plane", options.origin, parse_vector);
  command.add_value("--normal", "x,y,z", "Where it points to, all is cut away", options.normal, parse_vector);
  command.add_flag("--no-cut", "The plane shows its section and cuts nothing away", options.no_cut);
  command.add_flag("--no-section", "The plane cuts and shows no section", options.no_section);
  command.add_value(
      "--culled-from", "NUMBERS",
      "The mesh is refined and culled from this viewpoint (nine numbers: eye, target, upward direction), and "
      "seen from elsewhere",
      view.culled_from, parse_camera_place);
  command.add_flag("--edges", "Edges of triangles and of cells", view.edges);
  command.add_choice<Shading>("--shading",
                              "Lit by a light beside the eye, or as a sphere is with silhouettes",
                              view.shading, {{"lit", Shading::kLit}, {"sphere", Shading::kSphere}});
  command.add_flag("--plain", "Without axes, box, colour bar", view.plain);
  command.add_flag("--show-time",
                   "Of a series: the time and the number of the step are written on the picture, as a window "
                   "does unless --plain is given",
                   view.show_time);
}

void add_budget_options(const Command& command, ViewOptions& view) {
  command.add_value("--pixels", "E",
                    "The greatest isosurface error, an estimate of the distance to the surface of all "
                    "samples, as it is seen: in pixels (default 1)",
                    view.pixels, parse_number);
  command.add_flag("--occlusion", "Surfaces of stores stay coarse where the picture hides them",
                   view.occlusion);
  command.add_value("--step", "N", "Of a stored series: the number of the step that is seen (default 0)",
                    view.step, parse_count_from_0);
  command.add_value(
      "--max-triangles", "N",
      "Never more triangles of a store's surfaces in a frame, whatever the error (default 500000)",
      view.max_triangles, parse_count);
  command.add_value("--frame-time", "MS",
                    "For the mesh of a frame while the view moves: fewer triangles where there is no time "
                    "for all (default 0: any time)",
                    view.frame_milliseconds, parse_number);
}

void add_paging_options(const Command& command, ViewOptions& view) {
  command.add_choice<bool>(
      "--paging",
      "Whether surfaces wait for the pages of stores that they need, or are coarser at first and sharpen as "
      "these are loaded (default async in a window, wait offscreen)",
      view.waits_for_pages, {{"wait", true}, {"async", false}});
  command.add_choice<bool>(
      "--interpolation",
      "Where points and normals of surfaces of stores are interpolated: by the processor, once; or by the "
      "vertex shader in each picture, so that another step or isovalue comes sooner (default processor)",
      view.interpolates_in_shader, {{"processor", false}, {"shader", true}});
  add_memory_option(command, view.memory, "What the decoded pages of a store may take");
}

void add_offscreen_options(const Command& command, Options& options) {
  FlightOptions& flight = options.flight;
  command.add_flag("--offscreen", "Draw without a window: by a graphics device, or the processor",
                   options.offscreen);
  command.add_converted(
      "--camera-path", "orbit:N|FILE|bookmarks",
      "orbit:N: once round the data in N frames (default orbit:36); a file with a viewpoint "
      "on each line: eye, target and upward direction, nine numbers; or bookmarks: those of "
      "--state",
      [&flight](const std::string&, const std::string& text) { take_camera_path(text, flight); });
  command.add_file("--frames", "DIR", "The folder of the pictures: frame0001.png and so on", flight.frames);
  command.add_option("--steps", "A,B",
                     "Of a stored series: a frame of each step from A to B, while the camera goes along "
                     "--camera-path (default: it stands still)",
                     options.steps);
  command.add_file("--film", "F.mp4|F.webm|F.gif", "The frames as a film, by the program ffmpeg",
                   flight.film);
  command.add_value("--frame-rate", "N", "Frames of a film per second (default 10)", flight.frame_rate,
                    parse_number);
  command.add_flag("--overwrite", "Replace a folder of frames that is there", flight.overwrite);
  command.add_value("--size", "W,H", "Width and height of the window or the pictures", options.view.size,
                    parse_pixels);
  command.add_file("--state", "FILE",
                   "A state that the window remembered (JSON); offscreen its view is the only frame, unless "
                   "--camera-path is given",
                   options.view.state);
  command.add_flag("--fresh", "Do not go on from how these files were looked at last", options.view.fresh);
}

}  // namespace

void add_view(const Command& app, Session& session) {
  const auto [command, options] =
      add_command(app, session, "view", "Looks at stores, meshes and interfaces, in a window or without one",
                  "adamas view head.adm --isovalue 1150", run);
  command
      .add_option("input", "FILE...",
                  "Stores (.adm), meshes from adamas resample (.vtu), saved hierarchies (.h5), interfaces "
                  "(.vtp, .ply, .arec, .txt)",
                  options.files)
      .required();
  add_surface_options(command, options.view);
  add_look_options(command, options);
  add_budget_options(command, options.view);
  add_paging_options(command, options.view);
  add_offscreen_options(command, options);
}

}  // namespace adamas::cli
