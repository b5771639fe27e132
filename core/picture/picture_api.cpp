#include "core/picture/picture_api.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "core/geometry/plane.h"
#include "core/picture/colour_map.h"
#include "core/picture/material_colours.h"
#include "core/picture/slice_picture.h"

namespace adamas {

using namespace picture;

namespace {

LineSet to_lines(const std::string& name, const Stroke& stroke, const PlaneFrame& frame,
                 const std::vector<std::array<Vec3, 2>>& segments) {
  LineSet lines{name, stroke, {}};
  for (const auto& segment : segments) {
    for (const Vec3& p : segment) {
      const auto [x, y] = frame.coordinates(p);
      lines.points.push_back({x, y});
    }
  }
  return lines;
}

void check_slice(const Slice& slice) {
  const std::size_t count = slice.offsets.empty() ? 0 : slice.offsets.size() - 1;
  if (count == 0 || slice.offsets.back() != slice.points.size() ||
      !std::is_sorted(slice.offsets.begin(), slice.offsets.end()))
    fail("slice: expected the offsets of polygons up to {}, found others", slice.points.size());
  if (slice.polygon_materials.size() != count)
    fail("slice: expected materials of {} polygons, found {}", count, slice.polygon_materials.size());
  if (!slice.values.empty() && slice.values.size() != slice.points.size())
    fail("slice: expected values of {} points, found {}", slice.points.size(), slice.values.size());
}

Colour area_colour(const Slice& slice, const DrawingOptions& options, std::size_t material) {
  if (material >= slice.materials.size()) return material_area_colour(material);
  return colour_of(options.colours, slice.materials[material], material, material_area_colour);
}

SlicePanel to_panel(const Slice& slice, const PlaneFrame& frame, const DrawingOptions& options) {
  SlicePanel panel;
  for (std::size_t p = 0; p + 1 < slice.offsets.size(); ++p) {
    FieldPolygon polygon;
    for (std::size_t i = slice.offsets[p]; i < slice.offsets[p + 1]; ++i) {
      const auto [x, y] = frame.coordinates(slice.points[i]);
      polygon.points.push_back({x, y});
      if (!slice.values.empty()) polygon.values.push_back(slice.values[i]);
    }
    if (slice.values.empty()) polygon.colour = area_colour(slice, options, slice.polygon_materials[p]);
    panel.polygons.push_back(std::move(polygon));
  }
  if (options.cells) panel.lines.push_back(to_lines("cells", cell_stroke(), frame, slice.cell_edges));
  if (!slice.interface_edges.empty())
    panel.lines.push_back(
        to_lines("interfaces", approximated_interface_stroke(), frame, slice.interface_edges));
  return panel;
}

/// A legend of the materials that occur.
std::vector<LegendEntry> legend_of(const Slice& slice, const DrawingOptions& options) {
  std::vector<LegendEntry> entries;
  for (std::size_t m = 0; m < slice.materials.size(); ++m) {
    const auto& all = slice.polygon_materials;
    if (std::find(all.begin(), all.end(), m) != all.end())
      entries.push_back({slice.materials[m], area_colour(slice, options, m)});
  }
  return entries;
}

/// The corners of a triangle. Throws Error if one does not exist.
PictureTriangle corners(const std::vector<Vec3>& points, const std::array<std::uint32_t, 3>& triangle,
                        const Colour& colour) {
  for (const std::uint32_t p : triangle) {
    if (p >= points.size()) fail("picture: expected points below {}, found {}", points.size(), p);
  }
  const auto [a, b, c] = triangle;
  return {{points[a], points[b], points[c]}, colour};
}

/// A picture without triangles, with the view of the options. Throws Error (kUsage).
InterfacePicture empty_picture(const DrawingOptions& options) {
  check_surface_drawing(options);
  InterfacePicture picture;
  picture.direction = options.direction;
  picture.projection = options.projection;
  if (options.domain) picture.domain = *options.domain;
  picture.focus = options.focus;
  return picture;
}

/// The triangles that a picture shows, by the materials on their sides.
class ShownTriangles {
 public:
  ShownTriangles(const std::vector<ShownInterface>& shown, const std::vector<std::string>& materials,
                 const std::string& source) {
    for (const auto& [material, other] : shown) {
      const std::uint32_t first = find_material(materials, material, source);
      pairs_.push_back({first, other.empty() ? kAny : find_material(materials, other, source)});
    }
  }

  [[nodiscard]] bool contains(const std::array<std::uint32_t, 2>& sides) const {
    const auto fits = [&sides](const std::array<std::uint32_t, 2>& pair) {
      const auto [front, back] = sides;
      const auto [a, b] = pair;
      if (b == kAny) return front == a || back == a;
      return (front == a && back == b) || (front == b && back == a);
    };
    return pairs_.empty() || std::any_of(pairs_.begin(), pairs_.end(), fits);
  }

 private:
  static constexpr std::uint32_t kAny = ~std::uint32_t{0};

  static std::uint32_t find_material(const std::vector<std::string>& materials, const std::string& name,
                                     const std::string& source) {
    const auto found = std::find(materials.begin(), materials.end(), name);
    if (found != materials.end()) return static_cast<std::uint32_t>(found - materials.begin());
    std::string known;
    for (const std::string& each : materials) known += (known.empty() ? "'" : ", '") + each + "'";
    fail("{}: --show-interface: expected materials of {}, found '{}'", source, known, name);
  }

  std::vector<std::array<std::uint32_t, 2>> pairs_;
};

/// Throws Error unless the isosurfaces are parts of the surface.
void check_parts(const TriangleSurface& surface, const IsosurfaceParts& parts) {
  if (parts.ends.size() != parts.isovalues.size())
    fail("picture: expected the ends of {} isosurfaces, found {}", parts.isovalues.size(), parts.ends.size());
  if (!std::is_sorted(parts.ends.begin(), parts.ends.end()) ||
      (parts.ends.empty() ? 0 : parts.ends.back()) != surface.triangles.size())
    fail("picture: expected ends of isosurfaces up to {} triangles, found others", surface.triangles.size());
  if (!surface.normals.empty() && surface.normals.size() != surface.points.size())
    fail("picture: expected normals of {} points, found {}", surface.points.size(), surface.normals.size());
}

}  // namespace

namespace picture {

Colour colour_of(const std::map<std::string, std::array<double, 3>>& colours, const std::string& name,
                 std::size_t number, Colour (*otherwise)(std::size_t)) {
  const auto found = colours.find(name);
  if (found == colours.end()) return otherwise(number);
  const auto& [red, green, blue] = found->second;
  return {red, green, blue};
}

InterfacePicture interface_picture(const InterfaceTriangles& interfaces, const DrawingOptions& options) {
  // A legend cannot show more materials than these.
  constexpr std::size_t kMostNames = 24;
  if (interfaces.sides.size() != interfaces.triangles.size())
    fail("picture: expected sides of {} triangles, found {}", interfaces.triangles.size(),
         interfaces.sides.size());
  InterfacePicture picture = empty_picture(options);
  const ShownTriangles shown(options.shown, interfaces.materials, "picture");
  std::vector<char> seen(interfaces.materials.size(), 0);
  std::vector<Colour> colours;
  for (std::size_t m = 0; m < seen.size(); ++m)
    colours.push_back(colour_of(options.colours, interfaces.materials[m], m));
  for (std::size_t t = 0; t < interfaces.triangles.size(); ++t) {
    const auto [front, back] = interfaces.sides[t];
    for (const std::uint32_t m : {front, back}) {
      if (m >= seen.size()) fail("picture: expected materials below {}, found {}", seen.size(), m);
    }
    if (!shown.contains(interfaces.sides[t])) continue;
    seen[front] = seen[back] = 1;
    picture.triangles.push_back(corners(interfaces.points, interfaces.triangles[t], colours[back]));
    picture.triangles.back().back = colours[front];
  }
  if (static_cast<std::size_t>(std::count(seen.begin(), seen.end(), 1)) <= kMostNames) {
    for (std::size_t m = 0; m < seen.size(); ++m) {
      if (seen[m] != 0) picture.materials.push_back({interfaces.materials[m], colours[m]});
    }
  }
  return picture;
}

InterfacePictureOptions surface_drawing(const DrawingOptions& options) {
  InterfacePictureOptions drawing;
  drawing.width = options.width;
  drawing.height = options.height;
  drawing.triangle_edges = options.triangle_edges;
  return drawing;
}

}  // namespace picture

void write_picture(const std::filesystem::path& path, const Slice& slice, const DrawingOptions& options) {
  check_slice(slice);
  const PlaneFrame frame = plane_frame(slice.plane);
  SlicePicture picture;
  picture.title = to_string(slice.plane);
  picture.x_label = frame.right_name;
  picture.y_label = frame.up_name;
  picture.field_label = slice.field;
  picture.panels.push_back(to_panel(slice, frame, options));
  if (slice.values.empty()) picture.materials = legend_of(slice, options);
  if (options.range) picture.range = ValueRange{(*options.range)[0], (*options.range)[1]};
  SliceOptions size;
  size.width = options.width;
  size.greatest_height = options.height;
  write_slice(picture, path, size);
}

void write_picture(const std::filesystem::path& path, const TriangleSurface& surface,
                   const DrawingOptions& options) {
  InterfacePicture picture = empty_picture(options);
  for (const auto& triangle : surface.triangles)
    picture.triangles.push_back(corners(surface.points, triangle, kSurfaceColour));
  write_interfaces(picture, path, surface_drawing(options));
}

void write_picture(const std::filesystem::path& path, const TriangleSurface& surface,
                   const IsosurfaceParts& parts, const DrawingOptions& options) {
  check_parts(surface, parts);
  const bool several = parts.isovalues.size() > 1;
  InterfacePicture picture = empty_picture(options);
  const std::string values = fmt::format("{:.6g}", fmt::join(parts.isovalues, ", "));
  picture.title = parts.title + (several ? ", isovalues " : ", isovalue ") + values;
  if (surface.triangles.empty()) picture.message = "no surface at isovalue " + values;
  picture.triangles.reserve(surface.triangles.size());
  for (std::size_t n = 0; n < parts.ends.size(); ++n) {
    const Colour colour = several ? material_colour(n) : kSurfaceColour;
    if (several) picture.materials.push_back({fmt::format("{:.6g}", parts.isovalues[n]), colour});
    for (std::size_t t = picture.triangles.size(); t < parts.ends[n]; ++t) {
      picture.triangles.push_back(corners(surface.points, surface.triangles[t], colour));
      if (surface.normals.empty()) continue;
      const auto [a, b, c] = surface.triangles[t];
      picture.normals.push_back({surface.normals[a], surface.normals[b], surface.normals[c]});
    }
  }
  write_interfaces(picture, path, surface_drawing(options));
}

void write_picture(const std::filesystem::path& path, const InterfaceTriangles& interfaces,
                   const DrawingOptions& options) {
  write_interfaces(interface_picture(interfaces, options), path, surface_drawing(options));
}

void check_surface_drawing(const DrawingOptions& options) {
  if (!(squared_norm(options.direction) > 0))
    wrong_usage("--direction: expected a vector with a length, found 0");
  for (const double side : {options.width, options.height}) {
    if (!(side >= 200 && side <= 8000))
      wrong_usage("--size: expected a width and a height from 200 to 8000, found '{},{}'", options.width,
                  options.height);
  }
  for (const auto& [material, other] : options.shown) {
    if (material.empty() || material == other)
      wrong_usage("--show-interface: expected A or 'A|B' with two materials, found '{}{}{}'", material,
                  other.empty() ? "" : "|", other);
  }
}

void check_shown_interfaces(const std::vector<ShownInterface>& shown,
                            const std::vector<std::string>& materials, const std::string& source) {
  static_cast<void>(ShownTriangles(shown, materials, source));
}

std::vector<std::string> colour_map_names() { return ColourMap::names(); }

}  // namespace adamas
