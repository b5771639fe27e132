#pragma once

#include <string>
#include <utility>

#include "core/picture/canvas.h"
#include "core/picture/ticks.h"

namespace adamas::picture {

/// Colours and proportions that all figures share; lengths in units of the font size.
namespace figure_style {
inline constexpr Colour kInk{0.13, 0.13, 0.15};
inline constexpr Colour kFrame{0.35, 0.35, 0.38};
inline constexpr double kMargin = 1.0;
inline constexpr double kTickLength = 0.35;
inline constexpr double kTickGap = 0.35;
inline constexpr double kTickFont = 0.88;
inline constexpr double kTitleFont = 1.3;
inline constexpr double kTitleHeight = 2.3;
inline constexpr double kLabelHeight = 1.7;
/// The least font size in small pictures, in pixels: smaller text would be unreadable.
inline constexpr double kLeastFont = 11;
}  // namespace figure_style

/// The positions of an axis' values on the canvas: value `low` lies at `from`, `high` at `to`.
struct AxisScale {
  double low = 0, high = 1;
  double from = 0, to = 1;
  bool logarithmic = false;

  [[nodiscard]] double at(double value) const;
};

/// The width of the widest label in the font of tick labels.
double widest_label(const Ticks& ticks, double font_size);

/// Draws ticks outside the lower edge of `box`, with labels beneath and the axis label under them. Labels
/// that would touch their neighbour are left out.
void draw_x_axis(Canvas& canvas, const Box2& box, const AxisScale& scale, const Ticks& ticks,
                 const std::string& label, double font_size);

/// Draws ticks outside the left edge of `box`; the axis label stands upright at distance `label_distance`
/// from the edge.
void draw_y_axis(Canvas& canvas, const Box2& box, const AxisScale& scale, const Ticks& ticks,
                 const std::string& label, double label_distance, double font_size);

/// The height below the box that draw_x_axis needs.
double x_axis_height(const std::string& label, double font_size);

/// Clips a segment to the box; returns false if nothing of it is inside.
bool clip_segment(const Box2& box, Vec2& a, Vec2& b);

}  // namespace adamas::picture
