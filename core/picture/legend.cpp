#include "core/picture/legend.h"

#include <algorithm>
#include <array>

namespace adamas {
namespace {

// In units of the font size.
constexpr double kRowHeight = 1.6;
constexpr double kAreaWidth = 1.1, kLineWidth = 2.2;
constexpr double kSymbolGap = 0.5, kEntryGap = 1.8;

double symbol_width(const LegendEntry& entry) { return entry.area ? kAreaWidth : kLineWidth; }

}  // namespace

void draw_marker(Canvas& canvas, Marker marker, const Vec2& c, double radius, const Colour& colour) {
  const auto polygon = [&](std::initializer_list<Vec2> offsets) {
    std::vector<Vec2> points;
    for (const Vec2& offset : offsets) points.push_back(c + radius * offset);
    canvas.fill(points, colour);
  };
  switch (marker) {
    case Marker::kNone:
      break;
    case Marker::kDisc:
      canvas.disc(c, radius, colour);
      break;
    case Marker::kSquare:
      polygon({{-0.88, -0.88}, {0.88, -0.88}, {0.88, 0.88}, {-0.88, 0.88}});
      break;
    case Marker::kTriangle:
      polygon({{0, -1.2}, {1.1, 0.75}, {-1.1, 0.75}});
      break;
    case Marker::kDiamond:
      polygon({{0, -1.25}, {1.25, 0}, {0, 1.25}, {-1.25, 0}});
      break;
  }
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
      draw_marker(canvas, entry.marker, {at.x + 0.5 * width, middle}, 0.3 * f, entry.colour);
    }
    canvas.text(entry.name, {at.x + width + kSymbolGap * f, at.y}, {.size = f});
  }
}

}  // namespace adamas
