#include "core/picture/plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/picture/axes.h"
#include "core/picture/material_colours.h"

namespace adamas::picture {

using namespace figure_style;

namespace {

constexpr Colour kGrid{0.90, 0.90, 0.91};
constexpr std::array kMarkers{Marker::kDisc,    Marker::kSquare,        Marker::kTriangle,
                              Marker::kDiamond, Marker::kDownTriangle,  Marker::kPlus,
                              Marker::kHexagon, Marker::kCross,         Marker::kLeftTriangle,
                              Marker::kStar,    Marker::kRightTriangle, Marker::kBar};
/// Lengths of dashes and gaps in units of the font size. If two lines coincide, the lower one shows in the
/// gaps.
const std::array<std::vector<double>, 4> kDashes{
    {{0.5, 0.3}, {1.1, 0.35}, {0.9, 0.3, 0.2, 0.3}, {0.25, 0.25}}};

bool usable(double value, const PlotAxis& axis) {
  return std::isfinite(value) && (axis.kind == AxisKind::kLinear || value > 0);
}

bool usable(const Plot& plot, const PlotSeries& series, std::size_t i) {
  return usable(series.x[i], plot.x) && usable(series.y[i], plot.y);
}

// The ends of an axis: the requested ones, else those of the points with a small margin.
AxisScale axis_scale(const Plot& plot, const PlotAxis& axis, std::vector<double> PlotSeries::*values) {
  const bool logarithmic = axis.kind == AxisKind::kLogarithmic;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const PlotSeries& series : plot.series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!usable(plot, series, i)) continue;
      low = std::min(low, (series.*values)[i]);
      high = std::max(high, (series.*values)[i]);
    }
  }
  if (!(low <= high)) low = logarithmic ? 1 : 0, high = logarithmic ? 10 : 1;
  if (logarithmic) {
    const double air = std::max(std::pow(high / low, 0.05), 1.1);
    low /= air, high *= air;
  } else {
    const double air = high > low ? 0.05 * (high - low) : std::max(0.5 * std::abs(high), 0.5);
    // Zero is a natural end for quantities that start there.
    low = low >= 0 && low <= 0.25 * high ? 0 : low - air;
    high += air;
  }
  low = axis.low.value_or(low), high = axis.high.value_or(high);
  if (!(std::isfinite(low) && std::isfinite(high) && low < high && (!logarithmic || low > 0))) {
    fail("plot: axis '{}': expected a {}range that is not empty, found {} to {}", axis.label,
         logarithmic ? "positive " : "", low, high);
  }
  return {low, high, 0, 1, logarithmic};
}

Ticks axis_ticks(const AxisScale& scale, double wanted) {
  const int count = static_cast<int>(std::clamp(wanted, 2.0, 10.0));
  return scale.logarithmic ? log_ticks(scale.low, scale.high, count)
                           : linear_ticks(scale.low, scale.high, count);
}

class PlotDrawing {
 public:
  /// `at`: the upper left corner of the plot on the canvas.
  PlotDrawing(const Plot& plot, const PlotOptions& options, const Vec2& at)
      : plot_(plot),
        left_(at.x),
        top_(at.y),
        width_(options.width),
        height_(options.height),
        font_(options.font_size > 0 ? options.font_size : options.width / 62),
        legend_({}, 1, 1) {
    if (!(width_ >= 200 && width_ <= 16000 && height_ >= 150 && height_ <= 16000 && font_ <= width_ / 12)) {
      fail("plot: expected sides of 200 to 16000, found {} x {}, font size {}", width_, height_, font_);
    }
    for (const PlotSeries& series : plot.series) {
      if (series.x.size() != series.y.size()) {
        fail("plot: series '{}': expected as many y as x ({}), found {}", series.name, series.x.size(),
             series.y.size());
      }
    }
    place();
  }

  void draw(Canvas& canvas) const;

 private:
  void place();
  void draw_grid(Canvas& canvas) const;
  void draw_series(Canvas& canvas, std::size_t index) const;
  [[nodiscard]] LegendEntry style(std::size_t index) const;

  const Plot& plot_;
  double left_, top_, width_, height_, font_;
  Legend legend_;
  AxisScale x_scale_, y_scale_;
  Ticks x_ticks_, y_ticks_;
  double label_distance_ = 0;
  Box2 box_;
};

LegendEntry PlotDrawing::style(std::size_t index) const {
  const PlotSeries& series = plot_.series[index];
  LegendEntry entry{
      .name = series.name, .colour = series.colour.value_or(material_colour(index)), .area = false};
  entry.stroke = {.colour = entry.colour, .width = series.line ? 0.13 * font_ : 0};
  const auto before = [&](bool PlotSeries::*property) {
    return static_cast<std::size_t>(
        std::count_if(plot_.series.begin(), plot_.series.begin() + static_cast<std::ptrdiff_t>(index),
                      [property](const PlotSeries& other) { return other.*property; }));
  };
  if (series.dashed) {
    for (const double length : kDashes[before(&PlotSeries::dashed) % kDashes.size()])
      entry.stroke.dashes.push_back(length * font_);
  }
  if (series.markers)
    entry.marker = kMarkers[series.marker.value_or(before(&PlotSeries::markers)) % kMarkers.size()];
  entry.open = series.open;
  return entry;
}

void PlotDrawing::place() {
  const double f = font_;
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < plot_.series.size(); ++i) entries.push_back(style(i));
  legend_ = Legend(entries, width_ - 2 * kMargin * f, f);
  x_scale_ = axis_scale(plot_, plot_.x, &PlotSeries::x);
  y_scale_ = axis_scale(plot_, plot_.y, &PlotSeries::y);
  const double top = (kMargin + (plot_.title.empty() ? 0 : kTitleHeight)) * f;
  const double bottom =
      x_axis_height(plot_.x.label, f) + (legend_.height() > 0 ? 0.8 * f + legend_.height() : 0) + kMargin * f;
  y_ticks_ = axis_ticks(y_scale_, (height_ - top - bottom) / (2.6 * f));
  label_distance_ = (kTickLength + kTickGap) * f + widest_label(y_ticks_, f) + 0.7 * f;
  const double left = kMargin * f + label_distance_ + (plot_.y.label.empty() ? 0 : f);
  box_ = {{std::round(left_ + left), std::round(top_ + top)},
          {std::round(left_ + width_ - 2 * kMargin * f), std::round(top_ + height_ - bottom)}};
  if (box_.size().x < 4 * f || box_.size().y < 4 * f)
    fail("plot: expected room for the diagram, found {} x {}", width_, height_);
  x_scale_.from = box_.min.x, x_scale_.to = box_.max.x;
  y_scale_.from = box_.max.y, y_scale_.to = box_.min.y;
  x_ticks_ = axis_ticks(x_scale_, box_.size().x / (6 * f));
}

void PlotDrawing::draw_grid(Canvas& canvas) const {
  const Stroke stroke{.colour = kGrid, .width = 0.06 * font_};
  for (const double p : x_ticks_.positions) {
    canvas.polyline(std::array{Vec2{x_scale_.at(p), box_.min.y}, Vec2{x_scale_.at(p), box_.max.y}}, stroke);
  }
  for (const double p : y_ticks_.positions) {
    canvas.polyline(std::array{Vec2{box_.min.x, y_scale_.at(p)}, Vec2{box_.max.x, y_scale_.at(p)}}, stroke);
  }
}

void PlotDrawing::draw_series(Canvas& canvas, std::size_t index) const {
  const PlotSeries& series = plot_.series[index];
  const LegendEntry entry = style(index);
  const auto place_point = [&](std::size_t i) {
    return Vec2{x_scale_.at(series.x[i]), y_scale_.at(series.y[i])};
  };
  std::vector<Vec2> run;
  const auto flush = [&] {
    if (run.size() > 1) canvas.polyline(run, entry.stroke);
    run.clear();
  };
  for (std::size_t i = 0; series.line && i + 1 < series.x.size(); ++i) {
    Vec2 a{}, b{};
    const bool joined = usable(plot_, series, i) && usable(plot_, series, i + 1);
    if (joined) a = place_point(i), b = place_point(i + 1);
    if (!joined || !clip_segment(box_, a, b)) {
      flush();
      continue;
    }
    if (run.empty() || !(run.back() == a)) {
      flush();
      run.push_back(a);
    }
    run.push_back(b);
  }
  flush();
  for (std::size_t i = 0; series.markers && i < series.x.size(); ++i) {
    if (!usable(plot_, series, i)) continue;
    const Vec2 p = place_point(i);
    const bool inside = p.x >= box_.min.x && p.x <= box_.max.x && p.y >= box_.min.y && p.y <= box_.max.y;
    if (!inside) continue;
    draw_marker(canvas, entry.marker, p, (series.open ? 0.5 : 0.3) * font_, entry.colour,
                series.open ? 0.08 * font_ : 0);
  }
}

void PlotDrawing::draw(Canvas& canvas) const {
  const double f = font_;
  const TextStyle title{.size = kTitleFont * f, .colour = kInk, .bold = true};
  canvas.text(shortened(plot_.title, title, width_ - 2 * kMargin * f),
              {left_ + kMargin * f, top_ + (kMargin + kTitleFont) * f}, title);
  draw_grid(canvas);
  const std::array<Vec2, 4> frame{box_.min, Vec2{box_.max.x, box_.min.y}, box_.max,
                                  Vec2{box_.min.x, box_.max.y}};
  canvas.polyline(frame, {.colour = kFrame, .width = 0.06 * f}, true);
  for (std::size_t i = 0; i < plot_.series.size(); ++i) draw_series(canvas, i);
  draw_x_axis(canvas, box_, x_scale_, x_ticks_, plot_.x.label, f);
  draw_y_axis(canvas, box_, y_scale_, y_ticks_, plot_.y.label, label_distance_, f);
  legend_.draw(canvas, {box_.min.x, top_ + height_ - kMargin * f - legend_.height()});
}

}  // namespace

std::string draw_plot(const Plot& plot, PictureFormat format, const PlotOptions& options) {
  return draw_plots({&plot, 1}, format, options);
}

std::string draw_plots(std::span<const Plot> plots, PictureFormat format, const PlotOptions& options) {
  const std::size_t columns = options.columns > 0 ? std::min(options.columns, plots.size()) : plots.size();
  const std::size_t rows = columns > 0 ? (plots.size() + columns - 1) / columns : 0;
  std::vector<PlotDrawing> drawings;
  for (const Plot& plot : plots) {
    const auto column = static_cast<double>(drawings.size() % columns),
               row = static_cast<double>(drawings.size() / columns);
    drawings.emplace_back(plot, options, Vec2{options.width * column, options.height * row});
  }
  Canvas canvas(format, options.width * static_cast<double>(columns),
                options.height * static_cast<double>(rows));
  for (const PlotDrawing& drawing : drawings) drawing.draw(canvas);
  return canvas.finish(plots.empty() ? "" : plots.front().title);
}

}  // namespace adamas::picture
