#include "workflow/slices/slice_panels.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/base/error.h"
#include "core/data/volume_placement.h"
#include "core/picture/material_colours.h"

namespace adamas::workflow {

using namespace interfaces;
using namespace picture;

namespace {

/// A legend is left out if there are more materials than these.
constexpr std::size_t kMostNames = 30;
/// A smaller part of a section is round-off, so its material is not listed.
constexpr double kSeen = 1e-9;

Vec2 to_plane(const PlaneFrame& frame, const Vec3& p) {
  const auto c = frame.coordinates(p);
  return {c[0], c[1]};
}

LineSet to_lines(const PlaneFrame& frame, const std::string& name, const Stroke& stroke,
                 const std::vector<Segment>& segments) {
  LineSet lines{name, stroke};
  lines.points.reserve(2 * segments.size());
  for (const Segment& s : segments) {
    lines.points.push_back(to_plane(frame, s[0]));
    lines.points.push_back(to_plane(frame, s[1]));
  }
  return lines;
}

std::vector<FieldInfo> fields_of(const SliceInput& input, bool of_data) {
  if (input.cells) return field_infos(*input.cells);
  if (input.network) return {};
  return of_data ? field_infos(*input.data) : input.mesh->fields;
}

/// Replaces the letter of a component by its number: "NAME:x" by "NAME:0". Throws Error at components of a
/// scalar.
std::string with_index(const std::vector<FieldInfo>& fields, const std::string& text,
                       const std::string& source) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return text;
  const std::string name = text.substr(0, colon), component = text.substr(colon + 1);
  for (const FieldInfo& f : fields) {
    if (f.name == text) return text;
    if (f.name != name) continue;
    if (f.components == 1) {
      fail("{}: --field: expected '{}' alone, which has no components, found '{}'", source, name, text);
    }
    const std::size_t axis = std::string("xyz").find(component);
    if (f.components == 3 && component.size() == 1 && axis != std::string::npos) {
      return fmt::format("{}:{}", name, axis);
    }
  }
  return text;
}

/// Returns the stroke of the original interfaces. They are drawn below the approximated ones and wider, so
/// that both are visible where they agree.
Stroke original_below() { return {.colour = {0.6, 0.6, 0.6}, .width = 4.2}; }

/// Returns the colour of a material's areas: the one that the files have, or else one by its number.
Colour area_colour(const SliceInput& input, MaterialId m) {
  const auto found = input.colours.find(input.materials()[m]);
  if (found == input.colours.end()) return material_area_colour(m.value);
  const auto& [red, green, blue] = found->second;
  return {red, green, blue};
}

/// Makes a panel of a section: areas by field or material, cells and interfaces as lines.
SlicePanel make_panel(const SliceInput& input, SliceMode mode, const SliceStyle& style,
                      const CrossSection& section) {
  const PlaneFrame frame = plane_frame(style.plane);
  SlicePanel panel;
  constexpr std::array kTitles{"input", "plain linear interpolation", "fields per material"};
  panel.title =
      style.field.empty() && mode != SliceMode::kInput ? "mesh" : kTitles.at(static_cast<std::size_t>(mode));
  panel.polygons.reserve(section.pieces.size());
  for (const SectionPiece& piece : section.pieces) {
    FieldPolygon polygon;
    for (const Vec3& p : piece.corners) polygon.points.push_back(to_plane(frame, p));
    if (style.field.empty()) {
      polygon.colour = area_colour(input, piece.material);
    } else {
      polygon.values = piece.values;
    }
    panel.polygons.push_back(std::move(polygon));
  }
  if (mode == SliceMode::kInput ? style.input_cells : style.mesh_cells)
    panel.lines.push_back(to_lines(frame, "cells", cell_stroke(), section.cell_edges));
  if (!style.interfaces) return panel;
  if (input.interfaces) {
    panel.lines.push_back(to_lines(frame, input.mesh ? "original interfaces" : "interfaces",
                                   input.mesh ? original_below() : original_interface_stroke(),
                                   section_edges(*input.interfaces, style.plane, input.box())));
  }
  if (mode != SliceMode::kInput) {
    panel.lines.push_back(
        to_lines(frame, "approximated interfaces", approximated_interface_stroke(), section.interface_edges));
  }
  return panel;
}

/// Returns the materials of all pieces as entries of a legend; empty where there are too many.
std::vector<LegendEntry> material_legend(const SliceInput& input, const std::vector<CrossSection>& sections) {
  std::vector<LegendEntry> entries;
  for (MaterialId m(0); m.value < input.materials().size(); ++m.value) {
    bool shown = false;
    for (const CrossSection& s : sections) {
      shown = shown || (m.value < s.material_area.size() && s.material_area[m] > kSeen * s.area);
    }
    if (shown) entries.push_back({input.materials()[m], area_colour(input, m)});
  }
  if (entries.size() > kMostNames) entries.clear();
  return entries;
}

/// Transforms a section from the frame of a grid into space.
void place_in_space(const VolumeGrid& grid, CrossSection& section) {
  section.area = 0;
  std::fill(section.material_area.begin(), section.material_area.end(), 0.0);
  for (SectionPiece& piece : section.pieces) {
    for (Vec3& p : piece.corners) p = grid.in_space(p);
    if (grid.is_left_handed()) {
      std::reverse(piece.corners.begin(), piece.corners.end());
      std::reverse(piece.values.begin(), piece.values.end());
    }
    const double area = polygon_area(piece.corners);
    section.area += area;
    section.material_area[piece.material] += area;
  }
  for (auto* segments : {&section.cell_edges, &section.interface_edges}) {
    for (Segment& segment : *segments) {
      for (Vec3& p : segment) p = grid.in_space(p);
    }
  }
}

}  // namespace

std::vector<Vec3> SliceInput::outline(const Plane& plane) const {
  if (!turned) return clip_plane(plane, box());
  std::vector<Vec3> corners = clip_plane(plane_in_frame(*turned, plane), box());
  for (Vec3& p : corners) p = turned->in_space(p);
  return corners;
}

std::optional<FieldChoice> choose_field(const SliceInput& input, SliceMode mode, const SliceStyle& style) {
  if (style.field.empty()) return {};
  const bool of_data = mode == SliceMode::kInput;
  const std::vector<FieldInfo> fields = fields_of(input, of_data);
  const std::string& source = of_data && input.data ? input.data->source : input.name;
  return find_field(fields, with_index(fields, style.field, source), source);
}

CrossSection cut(const SliceInput& input, SliceMode mode, const SliceStyle& style) {
  const bool of_data = mode == SliceMode::kInput;
  const auto field = choose_field(input, mode, style);
  if (input.cells && field) return cross_section(*input.cells, style.plane, field, style.input_cells);
  if (input.network)
    return cross_section(*input.network->network, input.box(), input.materials().size(), style.plane,
                         input.name);
  if (of_data && input.turned) {
    CrossSection section =
        cross_section(*input.data, plane_in_frame(*input.turned, style.plane), field, style.input_cells);
    place_in_space(*input.turned, section);
    return section;
  }
  if (of_data) return cross_section(*input.data, style.plane, field, style.input_cells);
  return cross_section(*input.mesh, style.plane, field,
                       mode == SliceMode::kPlain ? SectionMode::kPlain : SectionMode::kPerMaterial);
}

std::string shown_field(const SliceInput& input, const SliceStyle& style) {
  const bool of_data = !input.mesh;
  if (of_data && !input.sample_name.empty()) return input.sample_name;
  const auto field = choose_field(input, of_data ? SliceMode::kInput : SliceMode::kMaterials, style);
  return field ? field_label(fields_of(input, of_data), *field) : std::string();
}

SlicePicture make_slice_picture(const SliceInput& input, const std::vector<SliceMode>& modes,
                                const SliceStyle& style, const std::vector<CrossSection>& sections) {
  const PlaneFrame frame = plane_frame(style.plane);
  SlicePicture picture;
  picture.title = std::filesystem::path(input.name).filename().string() + ", " + to_string(style.plane);
  picture.x_label = frame.right_name;
  picture.y_label = frame.up_name;
  picture.field_label = shown_field(input, style);
  for (std::size_t i = 0; i < modes.size(); ++i)
    picture.panels.push_back(make_panel(input, modes[i], style, sections[i]));
  // A single panel needs no title except the kind of interpolation of its field.
  if (modes.size() == 1 && (modes[0] == SliceMode::kInput || style.field.empty()))
    picture.panels[0].title.clear();
  if (style.field.empty()) picture.materials = material_legend(input, sections);
  return picture;
}

bool shows_cells(const SliceInput& input, const Plane& plane, const SliceOptions& size, std::size_t panels) {
  constexpr double kLeastPixels = 6;
  const PlaneFrame frame = plane_frame(plane);
  Box2 window;
  for (const Vec3& p : input.outline(plane)) {
    const auto [x, y] = frame.coordinates(p);
    window.extend({x, y});
  }
  double cell = std::numeric_limits<double>::infinity();
  const Vec3 extent = input.data->grid.domain().size();
  for (int axis = 0; axis < 3; ++axis) {
    if (plane.axis() == axis) continue;
    cell = std::min(cell, extent[axis] / static_cast<double>(input.data->grid.sites(axis)));
  }
  const Vec2 shown = window.size();
  const double scale =
      std::min(size.width / static_cast<double>(panels) / shown.x, size.greatest_height / shown.y);
  return cell * scale >= kLeastPixels;
}

}  // namespace adamas::workflow
