#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/picture/canvas.h"
#include "core/picture/colour_map.h"
#include "core/picture/legend.h"

namespace adamas::picture {

/// A convex polygon in the coordinates of the slice. With values, one per corner, it shows a field that is
/// linear over it; without them it is an area of one colour.
struct FieldPolygon {
  std::vector<Vec2> points{};
  std::vector<double> values{};
  Colour colour{};
};

/// Lines with one style: segments points[2k] to points[2k + 1], in the coordinates of the slice.
struct LineSet {
  std::string name{};  ///< its name in the legend; an empty one is not listed
  Stroke stroke{};     ///< the width in pixels of a picture 1600 pixels wide
  std::vector<Vec2> points{};
};

/// The strokes of the lines that slices have in common.
Stroke cell_stroke();
Stroke original_interface_stroke();
Stroke approximated_interface_stroke();

/// A least and a greatest value.
struct ValueRange {
  double low = 0, high = 1;
};

/// A drawing of a slice: areas below, lines above, each in the order given.
struct SlicePanel {
  std::string title{};
  std::vector<FieldPolygon> polygons{};
  std::vector<LineSet> lines{};
  /// The colour at a position in the plane, drawn below the polygons; called for each pixel, row by row from
  /// the top. Positions without a colour are white.
  std::function<std::optional<Colour>(const Vec2&)> colour_at{};
};

/// Panels side by side that show the same part of a plane with the same colour map.
struct SlicePicture {
  std::string title{};
  std::string x_label{}, y_label{};  ///< with their units, as "x [cm]"
  std::string field_label{};         ///< beside the colour bar, with its unit
  std::vector<SlicePanel> panels{};
  std::vector<LegendEntry> materials{};
  std::optional<Box2> window{};       ///< the part of the plane that is shown; default: that of the panels
  std::optional<ValueRange> range{};  ///< the values at the ends of the map; default: those of the panels
  ColourMap map = ColourMap::sequential();
};

/// Sizes in pixels (SVG and PDF: half points). A picture is narrower than `width` if it would exceed
/// `greatest_height`.
struct SliceOptions {
  double width = 1600;
  double greatest_height = 1400;
  double font_size = 0;  ///< 0: derived from the width
};

/// Draws the picture and returns the file's bytes. Throws Error if there is no panel, for points that are not
/// finite, and for a polygon with fewer values than points.
std::string draw_slice(const SlicePicture& picture, PictureFormat format, const SliceOptions& options = {});

/// Draws the picture as the pixels of the .png, for a film.
Raster draw_slice_frame(const SlicePicture& picture, const SliceOptions& options = {});

/// Writes a .png, .svg or .pdf file. It also throws Error if the file cannot be written.
void write_slice(const SlicePicture& picture, const std::filesystem::path& path,
                 const SliceOptions& options = {});

}  // namespace adamas::picture
