#include "cli/slice_panels.h"

#include <array>

#include "core/base/error.h"
#include "core/picture/palette.h"

namespace adamas {

namespace {

/// More materials than this make no legend.
constexpr std::size_t kMostNames = 30;
/// A smaller part of a section is round-off.
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
  return of_data ? field_infos(*input.data) : input.mesh->fields;
}

/// "NAME:x" as "NAME:0" where that is what it means; throws at components of a scalar.
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

/// Below the approximated interfaces and wider, so that both are seen where they agree.
Stroke original_below() { return {.colour = {0.6, 0.6, 0.6}, .width = 4.2}; }

}  // namespace

std::optional<FieldChoice> choose_field(const SliceInput& input, SliceMode mode, const SliceStyle& style) {
  if (style.field.empty()) return {};
  const bool of_data = mode == SliceMode::kInput;
  const std::vector<FieldInfo> fields = fields_of(input, of_data);
  const std::string& source = of_data ? input.data->source : input.name;
  return find_field(fields, with_index(fields, style.field, source), source);
}

CrossSection cut(const SliceInput& input, SliceMode mode, const SliceStyle& style) {
  const bool of_data = mode == SliceMode::kInput;
  const auto field = choose_field(input, mode, style);
  if (of_data) return cross_section(*input.data, style.plane, field);
  return cross_section(*input.mesh, style.plane, field,
                       mode == SliceMode::kPlain ? SectionMode::kPlain : SectionMode::kPerMaterial);
}

std::string shown_field(const SliceInput& input, const SliceStyle& style) {
  const bool of_data = !input.mesh;
  const auto field = choose_field(input, of_data ? SliceMode::kInput : SliceMode::kMaterials, style);
  return field ? field_label(fields_of(input, of_data), *field) : std::string();
}

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
      polygon.colour = material_area_colour(piece.material.value);
    } else {
      polygon.values = piece.values;
    }
    panel.polygons.push_back(std::move(polygon));
  }
  if (mode == SliceMode::kInput ? style.input_cells : style.mesh_cells)
    panel.lines.push_back(to_lines(frame, "cells", cell_stroke(), section.cell_edges));
  if (!style.interfaces) return panel;
  if (input.interfaces) {
    panel.lines.push_back(to_lines(frame, "original interfaces",
                                   input.mesh ? original_below() : original_interface_stroke(),
                                   section_edges(*input.interfaces, style.plane, input.box())));
  }
  if (mode != SliceMode::kInput) {
    panel.lines.push_back(
        to_lines(frame, "approximated interfaces", approximated_interface_stroke(), section.interface_edges));
  }
  return panel;
}

std::vector<LegendEntry> material_legend(const SliceInput& input, const std::vector<CrossSection>& sections) {
  std::vector<LegendEntry> entries;
  for (MaterialId m(0); m.value < input.materials().size(); ++m.value) {
    bool shown = false;
    for (const CrossSection& s : sections) {
      shown = shown || (m.value < s.material_area.size() && s.material_area[m] > kSeen * s.area);
    }
    if (shown) entries.push_back({input.materials()[m], material_area_colour(m.value)});
  }
  if (entries.size() > kMostNames) entries.clear();
  return entries;
}

}  // namespace adamas
