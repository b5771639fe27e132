#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/output_folder.h"
#include "cli/store_options.h"
#include "cli/usage_error.h"
#include "core/base/naming.h"
#include "core/io/input_file.h"
#include "core/picture/canvas.h"
#include "core/picture/colour_map.h"
#include "viewer/scene/flight.h"
#include "viewer/scene/remembered_states.h"
#include "viewer/scene/view_session.h"
#include "viewer/window/offscreen_pictures.h"
#include "viewer/window/window.h"

namespace adamas {

namespace {

struct Options {
  std::vector<std::string> paths, isovalues, opacities, hidden;
  std::string memory = "256M", colour_by, pixels, max_triangles, path, frames, size, shading, field, range,
              colour_map, plane, origin, normal, state, culled_from;
  bool offscreen = false, overwrite = false, edges = false, plain = false, no_cut = false, fresh = false;
};

struct Size {
  int width, height;
};

Size size_of(const Options& options, const Size& otherwise) {
  if (options.size.empty()) return otherwise;
  const std::vector<double> sides = parse_numbers("--size", options.size, 2);
  for (const double side : sides) {
    if (side < 16 || side > 8192 || side != static_cast<int>(side))
      wrong_usage("--size: expected a width and a height from 16 to 8192, found '{}'", options.size);
  }
  return {static_cast<int>(sides[0]), static_cast<int>(sides[1])};
}

std::optional<Plane> plane_of(const Options& options) {
  if (!options.plane.empty()) return parse_plane_option("--plane", options.plane);
  if (options.origin.empty() && options.normal.empty()) return std::nullopt;
  if (options.origin.empty() || options.normal.empty()) wrong_usage("expected both --origin and --normal");
  const Plane plane{parse_vector("--origin", options.origin), parse_vector("--normal", options.normal)};
  if (!(squared_norm(plane.normal) > 0)) wrong_usage("--normal: expected a vector with a length, found 0");
  return plane;
}

/// What options say of surfaces.
std::vector<SurfaceState> surfaces_of(const Options& options) {
  // Told apart, from the outermost on.
  constexpr std::array<Colour, 4> kColours{
      {{0.93, 0.85, 0.71}, {0.45, 0.62, 0.85}, {0.85, 0.45, 0.35}, {0.50, 0.72, 0.48}}};
  if (options.opacities.size() > options.isovalues.size())
    wrong_usage("--opacity: expected one for each --isovalue at most, found {}", options.opacities.size());
  std::vector<SurfaceState> surfaces;
  for (std::size_t n = 0; n < options.isovalues.size(); ++n) {
    SurfaceState surface;
    surface.isovalue = parse_numbers("--isovalue", options.isovalues[n], 1)[0];
    surface.colour = kColours[n % kColours.size()];
    if (n < options.opacities.size())
      surface.opacity = parse_numbers("--opacity", options.opacities[n], 1)[0];
    if (!(surface.opacity > 0 && surface.opacity <= 1))
      wrong_usage("--opacity: expected a number above 0 and at most 1, found '{}'", options.opacities[n]);
    surfaces.push_back(surface);
  }
  return surfaces;
}

std::optional<std::array<double, 2>> range_of(const Options& options) {
  if (options.range.empty()) return std::nullopt;
  const std::vector<double> ends = parse_numbers("--range", options.range, 2);
  if (!(ends[0] < ends[1])) wrong_usage("--range: expected a < b, found '{}'", options.range);
  return std::array{ends[0], ends[1]};
}

std::optional<Viewpoint> culled_from(const Options& options) {
  if (options.culled_from.empty()) return std::nullopt;
  std::istringstream text(options.culled_from);
  const Size size = size_of(options, {1024, 768});
  Viewpoint first;
  first.width_pixels = size.width;
  first.height_pixels = size.height;
  try {
    return read_viewpoints(text, "--culled-from", first).front();
  } catch (const Error& error) {
    wrong_usage("{}", error.what());
  }
}

/// All that can be wrong with options, before long work.
void check(const Options& options, const Session& session) {
  static_cast<void>(size_of(options, {1, 1}));
  static_cast<void>(plane_of(options));
  static_cast<void>(range_of(options));
  static_cast<void>(surfaces_of(options));
  static_cast<void>(culled_from(options));
  static_cast<void>(parse_size("--memory", options.memory));
  if (!options.pixels.empty()) static_cast<void>(parse_positive("--pixels", options.pixels));
  if (!options.max_triangles.empty())
    static_cast<void>(parse_count("--max-triangles", options.max_triangles));
  if (options.offscreen && options.frames.empty() && session.json.empty())
    wrong_usage("expected --frames or --json, found no output");
  if (options.offscreen) return;
  const char* unused = !options.frames.empty() ? "--frames"
                       : !session.json.empty() ? "--json"
                       : !options.path.empty() ? "--camera-path"
                                               : nullptr;
  if (unused != nullptr) wrong_usage("{}: expected --offscreen as well: a window writes no frames", unused);
}

void choose_field(const Options& options, const ViewSession& view, std::vector<DocumentState>& documents) {
  if (options.field.empty()) return;
  std::string known;
  bool is_found = false;
  for (std::size_t n = 0; n < documents.size(); ++n) {
    const DocumentFacts& facts = view.documents()[n]->facts();
    for (const std::string& field : facts.fields) known += (known.empty() ? "" : ", ") + field;
    if (std::ranges::find(facts.fields, options.field) == facts.fields.end()) continue;
    documents[n].field = options.field;
    documents[n].range = range_of(options);
    is_found = true;
  }
  if (!is_found)
    fail("--field: expected one of {}, found '{}'", known.empty() ? "none (no file has fields)" : known,
         options.field);
}

void hide_materials(const Options& options, const ViewSession& view, std::vector<DocumentState>& documents) {
  for (const std::string& name : options.hidden) {
    bool is_found = false;
    std::string known;
    for (std::size_t n = 0; n < documents.size(); ++n) {
      const std::vector<std::string>& materials = view.documents()[n]->facts().materials;
      for (const std::string& material : materials) known += (known.empty() ? "" : ", ") + material;
      if (std::ranges::find(materials, name) == materials.end()) continue;
      documents[n].hidden.insert(name);
      is_found = true;
    }
    if (!is_found)
      fail("--hide: expected one of {}, found '{}'", known.empty() ? "no material" : known, name);
  }
}

/// Brings what the options say into the state.
void apply(const Options& options, ViewSession& view) {
  ViewState& state = view.state();
  if (!options.pixels.empty()) state.pixels = parse_positive("--pixels", options.pixels);
  if (!options.max_triangles.empty())
    state.max_triangles = parse_count("--max-triangles", options.max_triangles);
  if (!options.shading.empty())
    state.shading = options.shading == "sphere" ? Shading::kSphere : Shading::kLit;
  if (!options.colour_map.empty()) state.colour_map = options.colour_map;
  if (options.edges) state.has_edges = true;
  if (options.plain) state.has_axes = state.has_box = state.has_colour_bar = false;
  if (const std::optional<Plane> plane = plane_of(options)) {
    state.cut.is_on = true;
    state.cut.plane = *plane;
    state.cut.cuts_away = !options.no_cut;
  }
  if (const std::optional<Viewpoint> viewpoint = culled_from(options)) state.culled_from = viewpoint;
  const std::vector<SurfaceState> surfaces = surfaces_of(options);
  for (std::size_t n = 0; n < state.documents.size(); ++n) {
    if (view.documents()[n]->facts().has_isovalues && !surfaces.empty())
      state.documents[n].surfaces = surfaces;
  }
  choose_field(options, view, state.documents);
  hide_materials(options, view, state.documents);
}

void open_files(const Options& options, ViewSession& view, Session& session) {
  DocumentOptions documents;
  documents.memory = parse_size("--memory", options.memory);
  documents.colour_by = options.colour_by;
  for (const std::string& path : options.paths) {
    session.outputs.protect(path);
    try {
      view.open(path, documents, session.console);
    } catch (const Error& error) {
      if (is_store(path) || !options.colour_by.empty()) throw;
      fail("{}", error.what());
    }
  }
  if (!options.colour_by.empty()) session.outputs.protect(options.colour_by);
}

void restore_state(const Options& options, ViewSession& view) {
  if (!options.state.empty()) {
    check_input_file(options.state);
    view.restore(view_state(read_file(options.state), options.state));
  } else if (!options.offscreen && !options.fresh) {
    if (const auto remembered = remembered_state(remembered_states_file(), options.paths))
      view.restore(*remembered);
  }
}

std::string frame_name(std::size_t n) { return fmt::format("frame{:04}.png", n + 1); }

Figures figures_of(const OffscreenPictures& pictures) {
  const UpdateReport& report = pictures.report();
  const DrawFigures& drawn = pictures.drawn();
  return {{"triangles", report.triangles},
          {"splits", report.splits},
          {"merges", report.merges},
          {"largest_error_pixels", report.largest_error_pixels},
          {"rendered_triangles", drawn.triangles},
          {"draw_calls", drawn.draw_calls},
          {"copied_bytes", drawn.copied_bytes},
          {"update_seconds", report.seconds},
          {"normal_seconds", report.normal_seconds},
          {"draw_seconds", pictures.draw_seconds()}};
}

/// Draws the frames into the folder, where there is one.
Figures fly(const Options& options, const Size& size, ViewSession& view, const OutputFolder* folder,
            Session& session) {
  // A state has a viewpoint of its own.
  const bool has_path = !options.path.empty() || options.state.empty();
  const std::vector<Viewpoint> path =
      has_path ? flight(options.path.empty() ? "orbit:36" : options.path, view.box(), size.width, size.height)
               : std::vector{view.state().viewpoint};
  OffscreenPictures pictures(view, size.width, size.height);
  Figures all = Figures::array();
  double seconds = 0, largest = 0;
  std::uint64_t most = 0;
  for (std::size_t n = 0; n < path.size(); ++n) {
    session.console.step("flying", static_cast<double>(n) / static_cast<double>(path.size()));
    const Raster raster = pictures.draw(path[n]);
    if (folder != nullptr) folder->fill([&] { write_png(folder->file(frame_name(n)), raster); });
    all.push_back(figures_of(pictures));
    seconds += pictures.report().seconds + pictures.report().normal_seconds + pictures.draw_seconds();
    largest = std::max(largest, pictures.report().largest_error_pixels);
    most = std::max(most, pictures.report().triangles);
  }
  session.console.clear();
  session.console.table(
      {{"frames", std::to_string(path.size())},
       {"most triangles", std::to_string(most)},
       {"largest error", fmt::format("{:.3g} pixels (estimate)", largest)},
       {"seconds a frame", fmt::format("{:.3f}", seconds / static_cast<double>(path.size()))},
       {"drawn by", pictures.drawn_by()}});
  return {{"drawn_by", pictures.drawn_by()}, {"frames", std::move(all)}};
}

void run_offscreen(const Options& options, Session& session) {
  const Size size = size_of(options, {1024, 768});
  std::optional<OutputFolder> folder;
  if (!options.frames.empty())
    folder.emplace(options.frames, options.overwrite, std::initializer_list<const char*>{"frame0001.png"});
  ViewSession view(size.width, size.height);
  open_files(options, view, session);
  restore_state(options, view);
  apply(options, view);
  Figures figures = fly(options, size, view, folder ? &*folder : nullptr, session);
  PageCounts counts;
  for (const auto& document : view.documents()) {
    const PageCounts some = document->page_counts();
    counts.pages += some.pages;
    counts.predictors += some.predictors;
    counts.bytes += some.bytes;
    counts.copies += some.copies;
    counts.damaged += some.damaged;
  }
  add_page_counts(counts, figures);
  figures["seconds"] = session.console.seconds();
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
  if (folder) folder->commit();
  session.outputs.commit();
}

void run_window(const Options& options, Session& session) {
  WindowOptions window;
  const Size size = size_of(options, {window.width, window.height});
  window.width = size.width;
  window.height = size.height;
  window.documents.memory = parse_size("--memory", options.memory);
  ViewSession view(size.width, size.height);
  open_files(options, view, session);
  restore_state(options, view);
  apply(options, view);
  session.console.clear();
  show_window(view, window);
  std::vector<std::string> names;
  for (const auto& document : view.documents()) names.push_back(document->facts().name);
  const std::filesystem::path memory = remembered_states_file();
  if (!memory.empty()) remember_state(memory, names, view.state());
}

void run(const Options& options, Session& session) {
  check(options, session);
  if (options.offscreen) {
    run_offscreen(options, session);
  } else {
    run_window(options, session);
  }
}

void add_contents_options(const Command& command, Options& options) {
  command
      .add_option(
          "--isovalue", options.isovalues,
          "The value of a store's surface; repeatable (default: between the two values of which there is "
          "most)")
      .one_value_each()
      .type_name("V");
  command.add_option("--opacity", options.opacities, "Of the surface of the same place among --isovalue")
      .one_value_each()
      .type_name("0..1");
  command
      .add_option("--colour-by,--color-by", options.colour_by, "Another store, whose values colour surfaces")
      .type_name("FILE");
  command.add_option("--field", options.field, "The field that colours show, NAME or NAME:x of a vector")
      .type_name("NAME");
  command.add_option("--range", options.range, "The field's values at the ends of the colour map")
      .type_name("a,b");
  command.add_option("--colour-map,--color-map", options.colour_map, "The colour map (default sequential)")
      .one_of(ColourMap::names());
  command.add_option("--hide", options.hidden, "A material that is not shown; repeatable")
      .one_value_each()
      .type_name("NAME");
  command.add_option("--plane", options.plane, "A plane that cuts, at right angles to an axis")
      .type_name("x=N|y=N|z=N");
  command.add_option("--origin", options.origin, "A point of the plane").type_name("x,y,z");
  command.add_option("--normal", options.normal, "Where it points to, all is cut away").type_name("x,y,z");
  command.add_flag("--no-cut", options.no_cut, "The plane shows its section and cuts nothing away");
  command
      .add_option(
          "--culled-from", options.culled_from,
          "The mesh is refined and culled from this viewpoint (nine numbers: eye, target, upward direction), "
          "and seen from elsewhere")
      .type_name("NUMBERS");
  command.add_flag("--edges", options.edges, "Edges of triangles and of cells");
  command
      .add_option("--shading", options.shading,
                  "Lit by a light beside the eye, or as a sphere is with silhouettes")
      .one_of({"lit", "sphere"});
  command.add_flag("--plain", options.plain, "Without axes, box, colour bar");
}

void add_budget_options(const Command& command, Options& options) {
  command
      .add_option(
          "--pixels", options.pixels,
          "The greatest isosurface error, an estimate of the distance to the surface of all samples, as it "
          "is seen: in pixels (default 1)")
      .type_name("E");
  command
      .add_option(
          "--max-triangles", options.max_triangles,
          "Never more triangles of a store's surfaces in a frame, whatever the error (default 500000)")
      .type_name("N");
  command
      .add_option("--memory", options.memory,
                  "What decoded pages may take, for each surface: bytes, or with K, M or G")
      .type_name("SIZE")
      .show_default();
}

void add_offscreen_options(const Command& command, Options& options) {
  command.add_flag("--offscreen", options.offscreen,
                   "Draw without a window: by a graphics device, or the processor");
  command
      .add_option(
          "--camera-path", options.path,
          "orbit:N: once round the data in N frames (default orbit:36); or a file with a viewpoint on each "
          "line: eye, target and upward direction, nine numbers")
      .type_name("orbit:N|FILE");
  command.add_option("--frames", options.frames, "The folder of the pictures: frame0001.png and so on")
      .type_name("DIR");
  command.add_flag("--overwrite", options.overwrite, "Replace a folder of frames that is there");
  command.add_option("--size", options.size, "Width and height of the window or the pictures")
      .type_name("W,H");
  command
      .add_option("--state", options.state,
                  "A state that the window remembered (JSON); offscreen its view is the only frame, unless "
                  "--camera-path is given")
      .type_name("FILE");
  command.add_flag("--fresh", options.fresh, "Do not go on from how these files were looked at last");
}

}  // namespace

void add_view(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(app, session, "view", "Looks at stores, meshes and interfaces, in a window or without one",
                  "adamas view head.adm --isovalue 1150 --offscreen --camera-path orbit:36 --frames frames",
                  [options, &session] { run(*options, session); });
  command
      .add_option(
          "input", options->paths,
          "Stores (.adm), meshes from adamas resample (.vtu), saved hierarchies (.h5), interfaces (.vtp, "
          ".ply, .arec, .txt)")
      .required()
      .type_name("FILE...");
  add_contents_options(command, *options);
  add_budget_options(command, *options);
  add_offscreen_options(command, *options);
}

}  // namespace adamas
