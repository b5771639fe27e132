#pragma once

#include <string>
#include <vector>

#include "core/picture/canvas.h"

namespace adamas::picture {

/// The shapes of the points in a plot.
enum class Marker {
  kNone,
  kDisc,
  kSquare,
  kTriangle,
  kDiamond,
  kDownTriangle,
  kPlus,
  kHexagon,
  kCross,
  kLeftTriangle,
  kStar,
  kRightTriangle,
  kBar
};

/// Draws a marker of the given radius; if its outline has a width, only the outline.
void draw_marker(Canvas& canvas, Marker marker, const Vec2& centre, double radius, const Colour& colour,
                 double outline = 0);

/// An entry of a legend: the colour of an area, or a line with or without a marker.
struct LegendEntry {
  std::string name{};
  Colour colour{};
  bool area = true;
  Stroke stroke{};  ///< the line; width 0 leaves it out
  Marker marker = Marker::kNone;
  bool open = false;  ///< whether only the outline of the marker is drawn
};

/// Entries in rows from left to right, wrapped to a width.
class Legend {
 public:
  /// The font size is in canvas units. Entries without a name are left out; names that are too wide are
  /// shortened.
  Legend(const std::vector<LegendEntry>& entries, double width, double font_size);

  /// The height; 0 without entries.
  [[nodiscard]] double height() const { return height_; }
  /// Draws the legend with its upper left corner at `corner`.
  void draw(Canvas& canvas, const Vec2& corner) const;

 private:
  struct Placed {
    LegendEntry entry;
    Vec2 at;  // left end of the base line
  };
  std::vector<Placed> placed_;
  double font_size_, height_ = 0;
};

}  // namespace adamas::picture
