#include <algorithm>
#include <string>

#include "adamas/picture.h"
#include "core/base/error.h"
#include "core/geometry/plane.h"
#include "core/picture/interface_picture.h"
#include "core/picture/palette.h"
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

SlicePanel to_panel(const Slice& slice, const PlaneFrame& frame, bool cells) {
  SlicePanel panel;
  for (std::size_t p = 0; p + 1 < slice.offsets.size(); ++p) {
    FieldPolygon polygon;
    for (std::size_t i = slice.offsets[p]; i < slice.offsets[p + 1]; ++i) {
      const auto [x, y] = frame.coordinates(slice.points[i]);
      polygon.points.push_back({x, y});
      if (!slice.values.empty()) polygon.values.push_back(slice.values[i]);
    }
    if (slice.values.empty()) polygon.colour = material_area_colour(slice.polygon_materials[p]);
    panel.polygons.push_back(std::move(polygon));
  }
  if (cells) panel.lines.push_back(to_lines("cells", cell_stroke(), frame, slice.cell_edges));
  if (!slice.interface_edges.empty())
    panel.lines.push_back(
        to_lines("interfaces", approximated_interface_stroke(), frame, slice.interface_edges));
  return panel;
}

/// The materials that are there.
std::vector<LegendEntry> legend_of(const Slice& slice) {
  std::vector<LegendEntry> entries;
  for (std::size_t m = 0; m < slice.materials.size(); ++m) {
    const auto& all = slice.polygon_materials;
    if (std::find(all.begin(), all.end(), m) != all.end())
      entries.push_back({slice.materials[m], material_area_colour(m)});
  }
  return entries;
}

InterfacePictureOptions sizes(const DrawingOptions& options) {
  InterfacePictureOptions sizes;
  sizes.width = options.width;
  sizes.height = options.height;
  return sizes;
}

/// The corners of a triangle. Throws Error where one is not there.
PictureTriangle corners(const std::vector<Vec3>& points, const std::array<std::uint32_t, 3>& triangle,
                        const Colour& colour) {
  for (const std::uint32_t p : triangle) {
    if (p >= points.size()) fail("picture: expected points below {}, found {}", points.size(), p);
  }
  const auto [a, b, c] = triangle;
  return {{points[a], points[b], points[c]}, colour};
}

}  // namespace

void write_picture(const std::filesystem::path& path, const Slice& slice, const DrawingOptions& options) {
  check_slice(slice);
  const PlaneFrame frame = plane_frame(slice.plane);
  SlicePicture picture;
  picture.title = to_string(slice.plane);
  picture.x_label = frame.right_name;
  picture.y_label = frame.up_name;
  picture.field_label = slice.field;
  picture.panels.push_back(to_panel(slice, frame, options.cells));
  if (slice.values.empty()) picture.materials = legend_of(slice);
  if (options.range) picture.range = ValueRange{(*options.range)[0], (*options.range)[1]};
  SliceOptions size;
  size.width = options.width;
  size.greatest_height = options.height;
  write_slice(picture, path, size);
}

void write_picture(const std::filesystem::path& path, const TriangleSurface& surface,
                   const DrawingOptions& options) {
  InterfacePicture picture;
  picture.direction = options.direction;
  for (const auto& triangle : surface.triangles)
    picture.triangles.push_back(corners(surface.points, triangle, kSurfaceColour));
  write_interfaces(picture, path, sizes(options));
}

void write_picture(const std::filesystem::path& path, const InterfaceTriangles& interfaces,
                   const DrawingOptions& options) {
  if (interfaces.sides.size() != interfaces.triangles.size())
    fail("picture: expected sides of {} triangles, found {}", interfaces.triangles.size(),
         interfaces.sides.size());
  InterfacePicture picture;
  picture.direction = options.direction;
  std::vector<char> shown(interfaces.materials.size(), 0);
  for (std::size_t t = 0; t < interfaces.triangles.size(); ++t) {
    const auto [front, back] = interfaces.sides[t];
    picture.triangles.push_back(corners(interfaces.points, interfaces.triangles[t], material_colour(back)));
    picture.triangles.back().back = material_colour(front);
    for (const std::uint32_t m : {front, back}) {
      if (m >= shown.size()) fail("picture: expected materials below {}, found {}", shown.size(), m);
      shown[m] = 1;
    }
  }
  for (std::size_t m = 0; m < shown.size(); ++m) {
    if (shown[m] != 0) picture.materials.push_back({interfaces.materials[m], material_colour(m)});
  }
  write_interfaces(picture, path, sizes(options));
}

}  // namespace adamas
