#include "core/picture/legend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace adamas::picture {
namespace {

// Lengths of the legend, in units of the font size.
constexpr double kRowHeight = 1.6;
constexpr double kAreaWidth = 1.1, kLineWidth = 2.2;
constexpr double kSymbolGap = 0.5, kEntryGap = 1.8;

double symbol_width(const LegendEntry& entry) { return entry.area ? kAreaWidth : kLineWidth; }

}  // namespace

namespace {

std::vector<Vec2> regular(std::size_t corners, double inner) {
  std::vector<Vec2> points;
  for (std::size_t n = 0; n < corners; ++n) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(corners);
    points.push_back((n % 2 == 0 ? 1.15 : inner) * Vec2{std::sin(angle), -std::cos(angle)});
  }
  return points;
}

/// The corners of two crossed bars, rotated by an angle.
std::vector<Vec2> cross_shape(double angle) {
  constexpr double kLong = 1.15, kShort = 0.38;
  const double c = std::cos(angle), s = std::sin(angle);
  std::vector<Vec2> points;
  Vec2 along{0, -1};
  for (int n = 0; n < 4; ++n) {
    const Vec2 across{-along.y, along.x};
    for (const Vec2& p :
         {kLong * along - kShort * across, kLong * along + kShort * across, kShort * along + kShort * across})
      points.push_back({c * p.x - s * p.y, s * p.x + c * p.y});
    along = across;
  }
  return points;
}

/// The corners of a marker with the radius 1.
std::vector<Vec2> marker_shape(Marker marker) {
  switch (marker) {
    case Marker::kNone:
      return {};
    case Marker::kDisc:
      return regular(32, 1.15);
    case Marker::kSquare:
      return {{-0.88, -0.88}, {0.88, -0.88}, {0.88, 0.88}, {-0.88, 0.88}};
    case Marker::kTriangle:
      return {{0, -1.2}, {1.1, 0.75}, {-1.1, 0.75}};
    case Marker::kDiamond:
      return {{0, -1.25}, {1.25, 0}, {0, 1.25}, {-1.25, 0}};
    case Marker::kDownTriangle:
      return {{0, 1.2}, {1.1, -0.75}, {-1.1, -0.75}};
    case Marker::kPlus:
      return cross_shape(0);
    case Marker::kHexagon:
      return regular(6, 1.15);
    case Marker::kCross:
      return cross_shape(std::numbers::pi / 4);
    case Marker::kLeftTriangle:
      return {{-1.2, 0}, {0.75, -1.1}, {0.75, 1.1}};
    case Marker::kStar:
      return regular(10, 0.5);
    case Marker::kRightTriangle:
      return {{1.2, 0}, {-0.75, -1.1}, {-0.75, 1.1}};
    case Marker::kBar:
      return {{-0.45, -1.25}, {0.45, -1.25}, {0.45, 1.25}, {-0.45, 1.25}};
  }
  return {};
}

}  // namespace

void draw_marker(Canvas& canvas, Marker marker, const Vec2& centre, double radius, const Colour& colour,
                 double outline) {
  if (marker == Marker::kDisc && outline == 0) return canvas.disc(centre, radius, colour);
  std::vector<Vec2> points = marker_shape(marker);
  if (points.empty()) return;
  for (Vec2& p : points) p = centre + radius * p;
  if (outline == 0) return canvas.fill(points, colour);
  canvas.polyline(points, {.colour = colour, .width = outline}, true);
}

Legend::Legend(const std::vector<LegendEntry>& entries, double width, double font_size)
    : font_size_(font_size) {
  const TextStyle style{.size = font_size};
  double x = 0, row = 0;
  for (LegendEntry entry : entries) {
    if (entry.name.empty()) continue;
    const double before = (symbol_width(entry) + kSymbolGap) * font_size;
    entry.name = shortened(entry.name, style, width - before);
    const double needed = before + text_width(entry.name, style);
    if (x > 0 && x + needed > width) x = 0, row += 1;
    placed_.push_back({entry, {x, (row + 0.5) * kRowHeight * font_size + 0.35 * font_size}});
    x += needed + kEntryGap * font_size;
    height_ = (row + 1) * kRowHeight * font_size;
  }
}

void Legend::draw(Canvas& canvas, const Vec2& corner) const {
  const double f = font_size_;
  for (const Placed& placed : placed_) {
    const LegendEntry& entry = placed.entry;
    const Vec2 at = corner + placed.at;
    const double middle = at.y - 0.35 * f, width = symbol_width(entry) * f;
    if (entry.area) {
      const Vec2 low{at.x, middle - 0.5 * f}, high{at.x + width, middle + 0.5 * f};
      canvas.fill_box({low, high}, entry.colour);
      const std::array<Vec2, 4> frame{low, Vec2{high.x, low.y}, high, Vec2{low.x, high.y}};
      canvas.polyline(frame, {.colour = {0.35, 0.35, 0.38}, .width = 0.04 * f}, true);
    } else {
      if (entry.stroke.width > 0)
        canvas.polyline(std::array{Vec2{at.x, middle}, Vec2{at.x + width, middle}}, entry.stroke);
      draw_marker(canvas, entry.marker, {at.x + 0.5 * width, middle}, 0.3 * f, entry.colour,
                  entry.open ? 0.08 * f : 0);
    }
    canvas.text(entry.name, {at.x + width + kSymbolGap * f, at.y}, {.size = f});
  }
}

}  // namespace adamas::picture
