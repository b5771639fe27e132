#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/picture/colour.h"
#include "core/picture/picture_file.h"
#include "core/picture/raster.h"
#include "core/picture/vec2.h"

namespace adamas::picture {

/// How a line is drawn; width in canvas units.
struct Stroke {
  Colour colour;
  double width = 1;
  double opacity = 1;
  std::vector<double> dashes{};  ///< lengths on and off in canvas units; empty: unbroken
};

/// How text is drawn; size in canvas units (the em).
struct TextStyle {
  double size = 16;
  Colour colour{0.13, 0.13, 0.15};
  bool bold = false;
};

/// Which point of the text is at the given position: its start, middle or end, on its base line.
enum class Anchor { kStart, kMiddle, kEnd };

/// The width of a line of text in canvas units, the same in every format.
double text_width(std::string_view text, const TextStyle& style);

/// The text, whose end is replaced by an ellipsis if it would be wider than `width`.
std::string shortened(std::string_view text, const TextStyle& style, double width);

/// A drawing surface with x to the right and y down, in units of pixels for PNG and of half a point for SVG
/// and PDF. The background is white. The same calls give the same bytes.
class Canvas {
 public:
  /// Throws Error unless both sides are in 1..32767.
  Canvas(PictureFormat format, double width, double height);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void polyline(std::span<const Vec2> points, const Stroke& stroke, bool closed = false);
  /// Draws separate segments, points[2k] to points[2k + 1].
  void segments(std::span<const Vec2> points, const Stroke& stroke);
  void fill(std::span<const Vec2> points, const Colour& colour, double opacity = 1);
  void fill_box(const Box2& box, const Colour& colour, double opacity = 1);
  void disc(const Vec2& centre, double radius, const Colour& colour);
  /// Draws a line of text. The angle is in degrees, counter-clockwise as seen.
  void text(std::string_view text, const Vec2& at, const TextStyle& style, Anchor anchor = Anchor::kStart,
            double angle = 0);
  /// Draws a raster stretched over the box, its pixels kept sharp.
  void image(const Raster& raster, const Box2& box);
  /// Limits drawing to the box, until unclip().
  void clip(const Box2& box);
  void unclip();

  /// The pixels that a PNG would show so far, without opacity.
  [[nodiscard]] Raster pixels() const;
  /// Ends the drawing and returns the file's bytes. The title goes into the document if the format has a
  /// place for it; in SVG it comes with all text drawn. Throws Error if Cairo fails.
  std::string finish(std::string_view title);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Writes a raster as .png. Throws Error if the file cannot be written.
void write_png(const std::filesystem::path& path, const Raster& raster);

}  // namespace adamas::picture
