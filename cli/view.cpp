#include "adamas/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
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

/// The options of `adamas view`; texts are empty where they were not given.
struct Options {
  std::vector<std::string> files;
  std::string colour_by, state, frames, film, steps, path, paging, interpolation, shading;
  std::optional<Vec3> origin, normal;
  bool offscreen = false, no_cut = false, no_section = false;
  ViewOptions view;
  FlightOptions flight;
};

/// Throws Error (kUsage) for options that have no effect.
void check_use(const Options& options, const Session& session) {
  if (options.offscreen) {
    if (options.frames.empty() && options.film.empty() && session.json.empty())
      wrong_usage("expected --frames, --film or --json, found no output");
    return;
  }
  if (options.flight.frame_rate && options.film.empty())
    wrong_usage("--frame-rate: expected a --film beside it, found none");
  const char* unused = !options.frames.empty()  ? "--frames"
                       : !options.film.empty()  ? "--film"
                       : !options.steps.empty() ? "--steps"
                       : !session.json.empty()  ? "--json"
                       : !options.path.empty()  ? "--camera-path"
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

void take_words(Options& options) {
  ViewOptions& view = options.view;
  FlightOptions& flight = options.flight;
  view.files.assign(options.files.begin(), options.files.end());
  view.colour_by = options.colour_by;
  view.state = options.state;
  if (!options.paging.empty()) view.waits_for_pages = options.paging == "wait";
  view.interpolates_in_shader = options.interpolation == "shader";
  if (!options.shading.empty()) view.shading = options.shading == "sphere" ? Shading::kSphere : Shading::kLit;
  if (!view.plane && options.origin.has_value() != options.normal.has_value())
    wrong_usage("expected both --origin and --normal");
  if (!view.plane && options.origin) view.plane = Plane{*options.origin, *options.normal};
  view.cuts_away = !options.no_cut;
  view.shows_section = !options.no_section;
  flight.frames = options.frames;
  flight.film = options.film;
  if (options.offscreen && !options.path.empty()) {
    flight.along_bookmarks = options.path == "bookmarks";
    if (!flight.along_bookmarks) flight.camera_path = parse_camera_path(options.path);
  }
  if (options.offscreen && !options.steps.empty())
    flight.steps = parse_step_range(
        options.steps, [&options] { return longest_series(options.files); }, "the series");
}

/// Parses two whole numbers; the library checks whether pictures can have such sides.
std::array<int, 2> parse_pixels(const std::string& option, const std::string& text) {
  constexpr double kMost = 1e9;
  const std::vector<double> sides = parse_numbers(option, text, 2);
  for (const double side : sides) {
    if (std::abs(side) > kMost || side != std::floor(side))
      wrong_usage("{}: expected a width and a height from 16 to 8192, found '{}'", option, text);
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
  figures["seconds"] = session.console.seconds();
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
  flight.finish();
  session.console.flush();
  flight.commit();
  session.commit();
}

void run(Options& options, Session& session) {
  check_use(options, session);
  // Messages name the first of these files.
  for (const std::string& file : options.files) session.outputs.protect(file);
  if (!options.colour_by.empty()) session.outputs.protect(options.colour_by);
  take_words(options);
  if (options.offscreen) return run_offscreen(options, session);
  ViewWindow window(options.view, session.console);
  session.console.clear();
  window.show(session.console);
}

/// Adds the options that say what pictures show of stores.
void add_surface_options(const Command& command, ViewOptions& view, std::string& colour_by) {
  command
      .add_converted_each(
          "--isovalue",
          "The value of a store's surface; repeatable (default: the one that parts the samples best in two)",
          [&view](const std::string& option, const std::string& text) {
            view.isovalues.push_back(parse_numbers(option, text, 1)[0]);
          })
      .type_name("V");
  command
      .add_converted_each("--opacity", "Of the surface of the same place among --isovalue",
                          [&view](const std::string& option, const std::string& text) {
                            view.opacities.push_back(parse_numbers(option, text, 1)[0]);
                          })
      .type_name("0..1");
  command.add_option("--colour-by,--color-by", colour_by, "Another store, whose values colour surfaces")
      .type_name("FILE");
  command.add_option("--field", view.field, "The field that colours show, NAME or NAME:x of a vector")
      .type_name("NAME");
  command
      .add_converted("--range",
                     "The values at the ends of the colour map, of the field or of a store's section",
                     [&view](const std::string& option, const std::string& text) {
                       const auto ends = parse_numbers(option, text, 2);
                       view.range = {ends[0], ends[1]};
                     })
      .type_name("a,b");
  command.add_option("--colour-map,--color-map", view.colour_map, "The colour map (default sequential)")
      .one_of(colour_map_names());
  command.add_option("--hide", view.hidden, "A material that is not shown; repeatable")
      .one_value_each()
      .type_name("NAME");
}

/// Adds the options of the cutting plane and of the appearance.
void add_look_options(const Command& command, Options& options) {
  ViewOptions& view = options.view;
  command
      .add_converted("--plane", "A plane that cuts, at right angles to an axis",
                     [&view](const std::string& option, const std::string& text) {
                       view.plane = parse_plane_option(option, text);
                     })
      .type_name("x=N|y=N|z=N");
  command
      .add_converted("--origin", "A point of the plane",
                     [&options](const std::string& option, const std::string& text) {
                       options.origin = parse_vector(option, text);
                     })
      .type_name("x,y,z");
  command
      .add_converted("--normal", "Where it points to, all is cut away",
                     [&options](const std::string& option, const std::string& text) {
                       options.normal = parse_vector(option, text);
                     })
      .type_name("x,y,z");
  command.add_flag("--no-cut", options.no_cut, "The plane shows its section and cuts nothing away");
  command.add_flag("--no-section", options.no_section, "The plane cuts and shows no section");
  command
      .add_converted(
          "--culled-from",
          "The mesh is refined and culled from this viewpoint (nine numbers: eye, target, upward direction), "
          "and seen from elsewhere",
          [&view](const std::string& option, const std::string& text) {
            view.culled_from = parse_camera_place(option, text);
          })
      .type_name("NUMBERS");
  command.add_flag("--edges", view.edges, "Edges of triangles and of cells");
  command
      .add_option("--shading", options.shading,
                  "Lit by a light beside the eye, or as a sphere is with silhouettes")
      .one_of({"lit", "sphere"});
  command.add_flag("--plain", view.plain, "Without axes, box, colour bar");
  command.add_flag("--show-time", view.show_time,
                   "Of a series: the time and the number of the step are written on the picture, as a window "
                   "does unless --plain is given");
}

void add_budget_options(const Command& command, ViewOptions& view) {
  command
      .add_converted(
          "--pixels",
          "The greatest isosurface error, an estimate of the distance to the surface of all samples, as it "
          "is seen: in pixels (default 1)",
          [&view](const std::string& option, const std::string& text) {
            view.pixels = parse_positive(option, text);
          })
      .type_name("E");
  command.add_flag("--occlusion", view.occlusion,
                   "Surfaces of stores stay coarse where the picture hides them");
  command
      .add_converted("--step", "Of a stored series: the number of the step that is seen (default 0)",
                     [&view](const std::string& option, const std::string& text) {
                       view.step = parse_count(option, text, 0);
                     })
      .type_name("N");
  command
      .add_converted(
          "--max-triangles",
          "Never more triangles of a store's surfaces in a frame, whatever the error (default 500000)",
          [&view](const std::string& option, const std::string& text) {
            view.max_triangles = parse_count(option, text);
          })
      .type_name("N");
  command
      .add_converted(
          "--frame-time",
          "For the mesh of a frame while the view moves: fewer triangles where there is no time for "
          "all (default 0: any time)",
          [&view](const std::string& option, const std::string& text) {
            view.frame_milliseconds = parse_numbers(option, text, 1)[0];
          })
      .type_name("MS");
}

void add_paging_options(const Command& command, Options& options) {
  command
      .add_option("--paging", options.paging,
                  "Whether surfaces wait for the pages of stores that they need, or are coarser at first and "
                  "sharpen as these are loaded (default async in a window, wait offscreen)")
      .one_of({"wait", "async"});
  command
      .add_option(
          "--interpolation", options.interpolation,
          "Where points and normals of surfaces of stores are interpolated: by the processor, once; or "
          "by the vertex shader in each picture, so that another step or isovalue comes sooner "
          "(default processor)")
      .one_of({"processor", "shader"});
  add_memory_option(command, options.view.memory, "What the decoded pages of a store may take");
}

void add_offscreen_options(const Command& command, Options& options) {
  command.add_flag("--offscreen", options.offscreen,
                   "Draw without a window: by a graphics device, or the processor");
  command
      .add_option("--camera-path", options.path,
                  "orbit:N: once round the data in N frames (default orbit:36); a file with a viewpoint on "
                  "each line: "
                  "eye, target and upward direction, nine numbers; or bookmarks: those of --state")
      .type_name("orbit:N|FILE|bookmarks");
  command.add_option("--frames", options.frames, "The folder of the pictures: frame0001.png and so on")
      .type_name("DIR");
  command
      .add_option("--steps", options.steps,
                  "Of a stored series: a frame of each step from A to B, while the camera goes along "
                  "--camera-path (default: it stands still)")
      .type_name("A,B");
  command.add_option("--film", options.film, "The frames as a film, by the program ffmpeg")
      .type_name("F.mp4|F.webm|F.gif");
  command
      .add_converted("--frame-rate", "Frames of a film per second (default 10)",
                     [&flight = options.flight](const std::string& option, const std::string& text) {
                       flight.frame_rate = parse_positive(option, text);
                     })
      .type_name("N");
  command.add_flag("--overwrite", options.flight.overwrite, "Replace a folder of frames that is there");
  command
      .add_converted("--size", "Width and height of the window or the pictures",
                     [&view = options.view](const std::string& option, const std::string& text) {
                       view.size = parse_pixels(option, text);
                     })
      .type_name("W,H");
  command
      .add_option("--state", options.state,
                  "A state that the window remembered (JSON); offscreen its view is the only frame, unless "
                  "--camera-path is given")
      .type_name("FILE");
  command.add_flag("--fresh", options.view.fresh, "Do not go on from how these files were looked at last");
}

}  // namespace

void add_view(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(app, session, "view", "Looks at stores, meshes and interfaces, in a window or without one",
                  "adamas view head.adm --isovalue 1150", [options, &session] { run(*options, session); });
  command
      .add_option(
          "input", options->files,
          "Stores (.adm), meshes from adamas resample (.vtu), saved hierarchies (.h5), interfaces (.vtp, "
          ".ply, .arec, .txt)")
      .required()
      .type_name("FILE...");
  add_surface_options(command, options->view, options->colour_by);
  add_look_options(command, *options);
  add_budget_options(command, options->view);
  add_paging_options(command, *options);
  add_offscreen_options(command, *options);
}

}  // namespace adamas::cli
