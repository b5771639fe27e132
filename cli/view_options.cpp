#include "cli/view_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>

#include "cli/option_values.h"
#include "cli/usage.h"
#include "core/picture/colour_map.h"
#include "isosurface/storage/store_format.h"
#include "isosurface/view/flight.h"

namespace adamas::cli {

using namespace isosurface;
using namespace picture;
using namespace viewer;

namespace {

std::optional<Plane> plane_of(const ViewOptions& options) {
  if (!options.plane.empty()) return parse_plane_option("--plane", options.plane);
  if (options.origin.empty() && options.normal.empty()) return std::nullopt;
  if (options.origin.empty() || options.normal.empty()) wrong_usage("expected both --origin and --normal");
  return parse_plane_at(options.origin, options.normal);
}

/// What options say of surfaces.
std::vector<SurfaceState> surfaces_of(const ViewOptions& options) {
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

std::optional<std::array<double, 2>> range_of(const ViewOptions& options) {
  if (options.range.empty()) return std::nullopt;
  return parse_range(options.range);
}

std::optional<double> frame_milliseconds(const ViewOptions& options) {
  if (options.frame_time.empty()) return std::nullopt;
  constexpr double kMost = 1e6;
  const double time = parse_numbers("--frame-time", options.frame_time, 1)[0];
  if (!(time >= 0 && time <= kMost))
    wrong_usage("--frame-time: expected milliseconds from 0 to {}, found '{}'", kMost, options.frame_time);
  return time;
}

std::optional<Viewpoint> culled_from(const ViewOptions& options) {
  if (options.culled_from.empty()) return std::nullopt;
  std::istringstream text(options.culled_from);
  const PictureSize size = picture_size(options, {1024, 768});
  Viewpoint first;
  first.width_pixels = size.width;
  first.height_pixels = size.height;
  try {
    return read_viewpoints(text, "--culled-from", first).front();
  } catch (const Error& error) {
    wrong_usage("{}", error.what());
  }
}

void choose_field(const ViewOptions& options, const ViewSession& view,
                  std::vector<DocumentState>& documents) {
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

void hide_materials(const ViewOptions& options, const ViewSession& view,
                    std::vector<DocumentState>& documents) {
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

void add_contents_options(const Command& command, ViewOptions& options) {
  command
      .add_option(
          "--isovalue", options.isovalues,
          "The value of a store's surface; repeatable (default: the one that parts the samples best in two)")
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
  command
      .add_option("--range", options.range,
                  "The values at the ends of the colour map, of the field or of a store's section")
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
  command.add_flag("--no-section", options.no_section, "The plane cuts and shows no section");
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
  command.add_flag("--show-time", options.show_time,
                   "Of a series: the time and the number of the step are written on the picture, as a window "
                   "does unless --plain is given");
}

void add_budget_options(const Command& command, ViewOptions& options) {
  command
      .add_option(
          "--pixels", options.pixels,
          "The greatest isosurface error, an estimate of the distance to the surface of all samples, as it "
          "is seen: in pixels (default 1)")
      .type_name("E");
  command.add_flag("--occlusion", options.occlusion,
                   "Surfaces of stores stay coarse where the picture hides them");
  command
      .add_option("--step", options.step,
                  "Of a stored series: the number of the step that is seen (default 0)")
      .type_name("N");
  command
      .add_option(
          "--max-triangles", options.max_triangles,
          "Never more triangles of a store's surfaces in a frame, whatever the error (default 500000)")
      .type_name("N");
  command
      .add_option("--frame-time", options.frame_time,
                  "For the mesh of a frame while the view moves: fewer triangles where there is no time for "
                  "all (default 0: any time)")
      .type_name("MS");
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
  command
      .add_option("--memory", options.memory,
                  "What the decoded pages of a store may take: bytes, or with K, M or G")
      .type_name("SIZE")
      .show_default();
}

void add_offscreen_options(const Command& command, ViewOptions& options) {
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
  command.add_option("--frame-rate", options.frame_rate, "Frames of a film per second (default 10)")
      .type_name("N");
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

void add_view_options(const Command& command, ViewOptions& options) {
  add_contents_options(command, options);
  add_budget_options(command, options);
  add_offscreen_options(command, options);
}

PictureSize picture_size(const ViewOptions& options, const PictureSize& otherwise) {
  if (options.size.empty()) return otherwise;
  const std::vector<double> sides = parse_numbers("--size", options.size, 2);
  for (const double side : sides) {
    if (side < 16 || side > 8192 || side != static_cast<int>(side))
      wrong_usage("--size: expected a width and a height from 16 to 8192, found '{}'", options.size);
  }
  return {static_cast<int>(sides[0]), static_cast<int>(sides[1])};
}

double film_rate(const ViewOptions& options) {
  constexpr double kRate = 10;
  return options.frame_rate.empty() ? kRate : parse_positive("--frame-rate", options.frame_rate);
}

bool waits_for_pages(const ViewOptions& options) {
  return options.paging.empty() ? options.offscreen : options.paging == "wait";
}

void check_view_options(const ViewOptions& options, const Session& session) {
  static_cast<void>(picture_size(options, {1, 1}));
  static_cast<void>(plane_of(options));
  static_cast<void>(range_of(options));
  static_cast<void>(surfaces_of(options));
  static_cast<void>(culled_from(options));
  static_cast<void>(parse_size("--memory", options.memory));
  if (!options.pixels.empty()) static_cast<void>(parse_positive("--pixels", options.pixels));
  if (!options.max_triangles.empty())
    static_cast<void>(parse_count("--max-triangles", options.max_triangles));
  if (!options.step.empty() && parse_count("--step", options.step, 0) >= kMostSteps)
    wrong_usage("--step: expected less than {}, found {}", kMostSteps, options.step);
  static_cast<void>(frame_milliseconds(options));
  static_cast<void>(film_rate(options));
  if (!options.steps.empty() && !options.step.empty())
    wrong_usage("--steps: expected no --step beside it, found '{}'", options.step);
  if (!options.frame_rate.empty() && options.film.empty())
    wrong_usage("--frame-rate: expected a --film beside it, found none");
  if (options.offscreen && options.frames.empty() && options.film.empty() && session.json.empty())
    wrong_usage("expected --frames, --film or --json, found no output");
  if (options.offscreen) return;
  const char* unused = !options.frames.empty()  ? "--frames"
                       : !options.film.empty()  ? "--film"
                       : !options.steps.empty() ? "--steps"
                       : !session.json.empty()  ? "--json"
                       : !options.path.empty()  ? "--camera-path"
                                                : nullptr;
  if (unused != nullptr) wrong_usage("{}: expected --offscreen as well: a window writes no frames", unused);
}

void apply_view_options(const ViewOptions& options, ViewSession& view) {
  ViewState& state = view.state();
  if (!options.pixels.empty()) state.pixels = parse_positive("--pixels", options.pixels);
  if (!options.max_triangles.empty())
    state.max_triangles = parse_count("--max-triangles", options.max_triangles);
  if (const std::optional<double> time = frame_milliseconds(options)) state.frame_milliseconds = *time;
  if (!options.shading.empty())
    state.shading = options.shading == "sphere" ? Shading::kSphere : Shading::kLit;
  if (!options.colour_map.empty()) state.colour_map = options.colour_map;
  if (options.edges) state.has_edges = true;
  if (!options.step.empty())
    view.set_step(static_cast<std::uint32_t>(parse_count("--step", options.step, 0)));
  if (options.occlusion) state.leaves_out_hidden = true;
  if (options.plain) state.has_axes = state.has_box = state.has_colour_bar = false;
  if (options.plain || options.offscreen) state.has_time = false;
  if (options.show_time) state.has_time = true;
  if (const std::optional<Plane> plane = plane_of(options)) {
    state.cut.is_on = true;
    state.cut.plane = *plane;
    state.cut.cuts_away = !options.no_cut;
    state.cut.shows_section = !options.no_section;
  }
  if (const std::optional<Viewpoint> viewpoint = culled_from(options)) state.culled_from = viewpoint;
  const std::vector<SurfaceState> surfaces = surfaces_of(options);
  for (std::size_t n = 0; n < state.documents.size(); ++n) {
    if (!view.documents()[n]->facts().has_isovalues) continue;
    if (!surfaces.empty()) state.documents[n].surfaces = surfaces;
    if (!options.range.empty()) state.documents[n].range = range_of(options);
  }
  choose_field(options, view, state.documents);
  hide_materials(options, view, state.documents);
}

}  // namespace adamas::cli
