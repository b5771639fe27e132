#include "core/picture/axes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace adamas::picture {

using namespace figure_style;

namespace {

// The distance from the middle of a line of digits down to its base line, in font sizes.
constexpr double kHalfDigit = 0.36;

TextStyle tick_style(double font_size) { return {.size = kTickFont * font_size, .colour = kInk}; }

void tick(Canvas& canvas, const Vec2& from, const Vec2& to, double font_size) {
  canvas.polyline(std::array{from, to}, {.colour = kFrame, .width = 0.06 * font_size});
}

}  // namespace

double AxisScale::at(double value) const {
  const double v = logarithmic ? std::log(value) : value, l = logarithmic ? std::log(low) : low,
               h = logarithmic ? std::log(high) : high;
  return h > l ? from + (v - l) / (h - l) * (to - from) : 0.5 * (from + to);
}

double widest_label(const Ticks& ticks, double font_size) {
  double widest = 0;
  for (const std::string& label : ticks.labels)
    widest = std::max(widest, text_width(label, tick_style(font_size)));
  return widest;
}

double x_axis_height(const std::string& label, double font_size) {
  return (kTickLength + kTickGap + kTickFont + (label.empty() ? 0 : kLabelHeight)) * font_size;
}

void draw_x_axis(Canvas& canvas, const Box2& box, const AxisScale& scale, const Ticks& ticks,
                 const std::string& label, double font_size) {
  const double f = font_size, bottom = box.max.y;
  for (const double p : ticks.minor)
    tick(canvas, {scale.at(p), bottom}, {scale.at(p), bottom + 0.5 * kTickLength * f}, f);
  double free_from = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ticks.positions.size(); ++i) {
    const double x = scale.at(ticks.positions[i]), width = text_width(ticks.labels[i], tick_style(f));
    tick(canvas, {x, bottom}, {x, bottom + kTickLength * f}, f);
    if (x - 0.5 * width < free_from) continue;
    canvas.text(ticks.labels[i], {x, bottom + (kTickLength + kTickGap + 0.8 * kTickFont) * f}, tick_style(f),
                Anchor::kMiddle);
    free_from = x + 0.5 * width + 0.5 * f;
  }
  const double width = box.size().x;
  const TextStyle style{.size = f, .colour = kInk};
  canvas.text(shortened(label, style, width),
              {box.min.x + 0.5 * width, bottom + x_axis_height(label, f) - 0.3 * f}, style, Anchor::kMiddle);
}

void draw_y_axis(Canvas& canvas, const Box2& box, const AxisScale& scale, const Ticks& ticks,
                 const std::string& label, double label_distance, double font_size) {
  const double f = font_size, left = box.min.x;
  for (const double p : ticks.minor)
    tick(canvas, {left, scale.at(p)}, {left - 0.5 * kTickLength * f, scale.at(p)}, f);
  double free_below = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ticks.positions.size(); ++i) {
    const double y = scale.at(ticks.positions[i]);
    tick(canvas, {left, y}, {left - kTickLength * f, y}, f);
    if (y + 0.5 * kTickFont * f > free_below) continue;
    canvas.text(ticks.labels[i], {left - (kTickLength + kTickGap) * f, y + kHalfDigit * kTickFont * f},
                tick_style(f), Anchor::kEnd);
    free_below = y - 0.6 * kTickFont * f;
  }
  const TextStyle style{.size = f, .colour = kInk};
  const double height = box.size().y;
  canvas.text(shortened(label, style, height), {left - label_distance, box.min.y + 0.5 * height}, style,
              Anchor::kMiddle, 90);
}

bool clip_segment(const Box2& box, Vec2& a, Vec2& b) {
  const Vec2 start = a, d = b - a;
  double enter = 0, leave = 1;
  const auto cut = [&](double step, double room) {  // keeps t with t * step <= room
    if (step == 0) return room >= 0;
    const double t = room / step;
    if (step > 0) leave = std::min(leave, t);
    if (step < 0) enter = std::max(enter, t);
    return true;
  };
  if (!cut(-d.x, start.x - box.min.x) || !cut(d.x, box.max.x - start.x) || !cut(-d.y, start.y - box.min.y) ||
      !cut(d.y, box.max.y - start.y) || enter > leave) {
    return false;
  }
  if (leave < 1) b = start + leave * d;
  if (enter > 0) a = start + enter * d;
  return true;
}

}  // namespace adamas::picture
