#include "viewer/api/view_options.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/picture/material_colours.h"
#include "isosurface/storage/store_format.h"
#include "isosurface/view/flight.h"
#include "timevarying/api/surface_options.h"

namespace adamas::viewer {

using namespace io;
using namespace isosurface;
using namespace picture;
using namespace timevarying;

namespace {

/// The size of pictures without a window, unless another one is given.
constexpr std::array<int, 2> kPictureSize{1024, 768};

void check_size(const ViewOptions& options) {
  for (const int side : picture_size(options, kPictureSize)) {
    if (side < 16 || side > 8192)
      wrong_usage("--size: expected a width and a height from 16 to 8192, found '{},{}'", (*options.size)[0],
                  (*options.size)[1]);
  }
}

void check_surfaces(const ViewOptions& options) {
  for (const double isovalue : options.isovalues) check_isovalue(isovalue);
  if (options.opacities.size() > options.isovalues.size())
    wrong_usage("--opacity: expected one for each --isovalue at most, found {}", options.opacities.size());
  for (const double opacity : options.opacities) {
    if (!(opacity > 0 && opacity <= 1))
      wrong_usage("--opacity: expected a number above 0 and at most 1, found '{}'", opacity);
  }
}

void check_budget(const ViewOptions& options) {
  constexpr double kMostMilliseconds = 1e6;
  if (options.pixels && !(*options.pixels > 0))
    wrong_usage("--pixels: expected a positive number, found '{}'", *options.pixels);
  if (options.step && *options.step >= kMostSteps)
    wrong_usage("--step: expected less than {}, found {}", kMostSteps, *options.step);
  if (const std::optional<double>& time = options.frame_milliseconds;
      time && !(*time >= 0 && *time <= kMostMilliseconds))
    wrong_usage("--frame-time: expected milliseconds from 0 to {}, found '{}'", kMostMilliseconds, *time);
}

/// The viewpoint for which meshes are refined and culled.
std::optional<Viewpoint> culled_from(const ViewOptions& options) {
  if (!options.culled_from) return std::nullopt;
  Viewpoint first;
  const auto [width, height] = picture_size(options, kPictureSize);
  first.width_pixels = width;
  first.height_pixels = height;
  try {
    return viewpoint_at(*options.culled_from, "--culled-from", first);
  } catch (const Error& error) {
    wrong_usage("{}", error.what());
  }
}

/// The surfaces of stores that the options specify.
std::vector<SurfaceState> wanted_surfaces(const ViewOptions& options) {
  // The colours are easy to distinguish, from the outermost surface inwards.
  constexpr std::array<Colour, 4> kColours{
      {kSurfaceColour, {0.45, 0.62, 0.85}, {0.85, 0.45, 0.35}, {0.50, 0.72, 0.48}}};
  std::vector<SurfaceState> surfaces;
  for (std::size_t n = 0; n < options.isovalues.size(); ++n) {
    SurfaceState surface;
    surface.isovalue = options.isovalues[n];
    surface.colour = kColours[n % kColours.size()];
    if (n < options.opacities.size()) surface.opacity = options.opacities[n];
    surfaces.push_back(surface);
  }
  return surfaces;
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
    documents[n].range = options.range;
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

}  // namespace

void check_view_options(const ViewOptions& options) {
  check_size(options);
  if (options.plane && !(squared_norm(options.plane->normal) > 0))
    wrong_usage("--normal: expected a vector with a length, found 0");
  if (options.range && !((*options.range)[0] < (*options.range)[1]))
    wrong_usage("--range: expected a < b in a,b, found '{},{}'", (*options.range)[0], (*options.range)[1]);
  check_surfaces(options);
  static_cast<void>(culled_from(options));
  check_budget(options);
}

DocumentOptions document_options(const ViewOptions& options, ViewPlace place) {
  DocumentOptions documents;
  documents.colour_by = options.colour_by.string();
  documents.memory = options.memory;
  documents.waits_for_pages = options.waits_for_pages.value_or(place == ViewPlace::kOffscreen);
  documents.interpolates_in_shader = options.interpolates_in_shader;
  if (options.step) documents.step = static_cast<std::uint32_t>(*options.step);
  return documents;
}

std::array<int, 2> picture_size(const ViewOptions& options, const std::array<int, 2>& otherwise) {
  return options.size.value_or(otherwise);
}

void apply_view_options(const ViewOptions& options, ViewPlace place, ViewSession& view) {
  ViewState& state = view.state();
  if (options.pixels) state.pixels = *options.pixels;
  if (options.max_triangles) state.max_triangles = *options.max_triangles;
  if (options.frame_milliseconds) state.frame_milliseconds = *options.frame_milliseconds;
  if (options.shading) state.shading = *options.shading;
  if (!options.colour_map.empty()) state.colour_map = options.colour_map;
  if (options.edges) state.has_edges = true;
  if (options.step) view.set_step(static_cast<std::uint32_t>(*options.step));
  if (options.occlusion) state.leaves_out_hidden = true;
  if (options.plain) state.has_axes = state.has_box = state.has_colour_bar = false;
  if (options.plain || place == ViewPlace::kOffscreen) state.has_time = false;
  if (options.show_time) state.has_time = true;
  if (options.plane) {
    state.cut.is_on = true;
    state.cut.plane = *options.plane;
    state.cut.cuts_away = options.cuts_away;
    state.cut.shows_section = options.shows_section;
  }
  if (const std::optional<Viewpoint> viewpoint = culled_from(options)) state.culled_from = viewpoint;
  const std::vector<SurfaceState> surfaces = wanted_surfaces(options);
  for (std::size_t n = 0; n < state.documents.size(); ++n) {
    if (!view.documents()[n]->facts().has_isovalues) continue;
    if (!surfaces.empty()) state.documents[n].surfaces = surfaces;
    if (options.range) state.documents[n].range = options.range;
  }
  choose_field(options, view, state.documents);
  hide_materials(options, view, state.documents);
}

void restore_state(const ViewOptions& options, ViewSession& view) {
  if (options.state.empty()) return;
  check_input_file(options.state);
  view.restore(view_state(read_file(options.state), options.state.string()));
}

}  // namespace adamas::viewer
