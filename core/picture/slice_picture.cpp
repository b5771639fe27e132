#include "core/picture/slice_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/picture/axes.h"
#include "core/picture/slice_contents.h"

namespace adamas::picture {

using namespace figure_style;

namespace {

constexpr int kSamplesPerPixel = 2;  // the number along each axis
constexpr double kStrokeReference = 1600;
constexpr double kBarWidth = 1.2;
/// The least width of panels, in units of the font size; if they would be narrower, something beside them is
/// left out.
constexpr double kLeastPanel = 7;

constexpr int kMostTicks = 10;

int tick_count(double length, double spacing) {
  return static_cast<int>(std::clamp(length / spacing, 1.0, static_cast<double>(kMostTicks)));
}

// The width of the widest label that an axis may get. It does not depend on the number of ticks, since that
// depends on the panels' size, which depends on this width.
double widest_possible_label(double low, double high, double font_size) {
  double widest = 0;
  for (int wanted = 1; wanted <= kMostTicks; ++wanted) {
    widest = std::max(widest, widest_label(linear_ticks(low, high, wanted), font_size));
  }
  return widest;
}

class SliceDrawing {
 public:
  SliceDrawing(const SlicePicture& picture, const SliceOptions& options)
      : picture_(picture),
        contents_(survey_slice(picture)),
        window_(shown_window(contents_.window)),
        font_(options.font_size > 0 ? options.font_size : std::max(options.width / 80, kLeastFont)),
        stroke_scale_(options.width / kStrokeReference),
        legend_({}, 1, 1) {
    if (!(options.width >= 200 && options.width <= 16000 && options.greatest_height >= 200 &&
          options.font_size <= options.width / 20)) {
      fail(
          "slice picture: expected a width of 200 to 16000 and a height from 200, found {} x {}, font size "
          "{}",
          options.width, options.greatest_height, font_);
    }
    place(options);
  }

  std::string draw(PictureFormat format) const;
  [[nodiscard]] Raster frame() const;

 private:
  void draw_on(Canvas& canvas, PictureFormat format) const;
  /// Leaves out the parts for which there is no room.
  void place(const SliceOptions& options);
  void place_panels(const SliceOptions& options);
  void place_ticks();
  /// The height of the parts below the panels, in a picture of that width.
  double height_below(double width);
  void draw_panel(Canvas& canvas, std::size_t index, PictureFormat format) const;
  void draw_colours(Canvas& canvas, const SlicePanel& panel, const Box2& box) const;
  void draw_areas(Canvas& canvas, const SlicePanel& panel, const Box2& box, PictureFormat format) const;
  void draw_bar(Canvas& canvas) const;
  [[nodiscard]] std::vector<LegendEntry> legend_entries() const;
  [[nodiscard]] std::string label(const std::string& text) const {
    return shown_.labels ? text : std::string();
  }
  [[nodiscard]] Box2 panel_box(std::size_t index) const {
    const double x = left_ + static_cast<double>(index) * (panel_size_.x + gap_);
    return {{x, top_}, {x + panel_size_.x, top_ + panel_size_.y}};
  }

  /// The parts of a picture that are drawn.
  struct Shown {
    bool labels = true;   ///< labels of the axes and the colour bar
    bool numbers = true;  ///< numbers at the ticks of the axes
    bool bar = true;
    bool legend = true;
  };

  const SlicePicture& picture_;
  SliceContents contents_;
  Shown shown_;
  Box2 window_;
  double font_, stroke_scale_;
  Legend legend_;
  double width_ = 0, height_ = 0, left_ = 0, right_ = 0, top_ = 0, gap_ = 0, label_distance_ = 0,
         bar_label_width_ = 0;
  Vec2 panel_size_;
  Ticks x_ticks_, y_ticks_, bar_ticks_;
};

std::vector<LegendEntry> SliceDrawing::legend_entries() const {
  std::vector<LegendEntry> entries = picture_.materials;
  if (contents_.has_missing) entries.push_back({.name = "no data", .colour = ColourMap::no_data()});
  for (const SlicePanel& panel : picture_.panels) {
    for (const LineSet& lines : panel.lines) {
      const auto same = [&](const LegendEntry& entry) { return !entry.area && entry.name == lines.name; };
      if (lines.name.empty() || std::any_of(entries.begin(), entries.end(), same)) continue;
      Stroke stroke = lines.stroke;
      // A hairline would be invisible in the legend.
      stroke.width = std::max(stroke.width, 2.0) * stroke_scale_;
      stroke.opacity = std::max(stroke.opacity, 0.6);
      entries.push_back({.name = lines.name, .colour = stroke.colour, .area = false, .stroke = stroke});
    }
  }
  return entries;
}

double SliceDrawing::height_below(double width) {
  const double f = font_;
  legend_ = Legend(shown_.legend ? legend_entries() : std::vector<LegendEntry>(), width - 2 * kMargin * f, f);
  return (shown_.numbers ? x_axis_height(label(picture_.x_label), f) : 0) +
         (legend_.height() > 0 ? 0.8 * f + legend_.height() : 0) + kMargin * f;
}

void SliceDrawing::place(const SliceOptions& options) {
  shown_.bar = contents_.has_field;
  place_panels(options);
  for (bool Shown::*part : {&Shown::labels, &Shown::numbers, &Shown::bar}) {
    if (panel_size_.x >= kLeastPanel * font_) break;
    shown_.*part = false;
    place_panels(options);
  }
  const auto count = static_cast<double>(picture_.panels.size());
  if (panel_size_.x < 4 * font_)
    fail("slice picture: expected room for {} panels, found a width of {}", count, options.width);
  const Vec2 size = window_.size();
  panel_size_.y = std::round(panel_size_.x * size.y / size.x);
  const double least = 8 * font_;
  if (options.greatest_height - top_ - height_below(options.width) < least) shown_.legend = false;
  const double room = std::max(options.greatest_height - top_ - height_below(options.width), least);
  if (panel_size_.y > room) {
    panel_size_.y = std::floor(room);
    panel_size_.x = std::max(std::round(panel_size_.y * size.x / size.y), 2.0);
  }
  const TextStyle title_style{.size = kTitleFont * font_, .bold = true};
  const double title_width =
      std::min(text_width(picture_.title, title_style) + 2 * kMargin * font_, options.width);
  const double needed = left_ + right_ + count * panel_size_.x + (count - 1) * gap_;
  width_ = std::max({needed, title_width, std::min(24 * font_, options.width)});
  left_ += std::floor(0.5 * (width_ - needed));
  height_ = std::ceil(top_ + panel_size_.y + height_below(width_));
  place_ticks();
}

void SliceDrawing::place_panels(const SliceOptions& options) {
  const double f = font_, count = static_cast<double>(picture_.panels.size());
  const double y_number = shown_.numbers ? widest_possible_label(window_.min.y, window_.max.y, f) : 0;
  const double x_number = shown_.numbers ? widest_possible_label(window_.min.x, window_.max.x, f) : 0;
  bar_label_width_ = widest_possible_label(contents_.range.low, contents_.range.high, f);
  label_distance_ = (kTickLength + kTickGap) * f + y_number + 0.7 * f;
  left_ = std::ceil(kMargin * f + (shown_.numbers ? label_distance_ : 0) +
                    (label(picture_.y_label).empty() ? 0 : f));
  gap_ = std::ceil(std::max(1.5 * f, x_number + 0.5 * f));
  const double bar = (1 + kBarWidth + kTickLength + kTickGap) * f + bar_label_width_ +
                     (label(picture_.field_label).empty() ? 0 : kLabelHeight * f);
  right_ = std::ceil(kMargin * f + (shown_.bar ? bar : 0.5 * x_number));
  const bool titled = std::any_of(picture_.panels.begin(), picture_.panels.end(),
                                  [](const SlicePanel& p) { return !p.title.empty(); });
  top_ = std::ceil((kMargin + (picture_.title.empty() ? 0 : kTitleHeight) + (titled ? kLabelHeight : 0)) * f);
  panel_size_.x = std::floor((options.width - left_ - right_ - (count - 1) * gap_) / count);
}

void SliceDrawing::place_ticks() {
  const double f = font_;
  bar_ticks_ = linear_ticks(contents_.range.low, contents_.range.high, tick_count(panel_size_.y, 3 * f));
  if (!shown_.numbers) return;
  const double x_number = widest_possible_label(window_.min.x, window_.max.x, f);
  x_ticks_ = linear_ticks(window_.min.x, window_.max.x, tick_count(panel_size_.x, x_number + 2.5 * f));
  y_ticks_ = linear_ticks(window_.min.y, window_.max.y, tick_count(panel_size_.y, 3 * f));
}

void SliceDrawing::draw_colours(Canvas& canvas, const SlicePanel& panel, const Box2& box) const {
  Raster raster(static_cast<int>(panel_size_.x), static_cast<int>(panel_size_.y));
  const double sx = window_.size().x / raster.width(), sy = window_.size().y / raster.height();
  for (int y = 0; y < raster.height(); ++y) {
    for (int x = 0; x < raster.width(); ++x) {
      const Vec2 place{window_.min.x + (x + 0.5) * sx, window_.max.y - (y + 0.5) * sy};
      if (const auto colour = panel.colour_at(place)) raster.set(x, y, *colour);
    }
  }
  canvas.image(raster, box);
}

void SliceDrawing::draw_areas(Canvas& canvas, const SlicePanel& panel, const Box2& box,
                              PictureFormat format) const {
  if (panel.colour_at) draw_colours(canvas, panel, box);
  if (panel.polygons.empty()) return;
  const int width = static_cast<int>(panel_size_.x) * kSamplesPerPixel,
            height = static_cast<int>(panel_size_.y) * kSamplesPerPixel;
  Raster raster(width, height);
  const double sx = width / window_.size().x, sy = height / window_.size().y;
  std::vector<Vec2> points;
  for (const FieldPolygon& polygon : panel.polygons) {
    points.clear();
    for (const Vec2& p : polygon.points)
      points.push_back({(p.x - window_.min.x) * sx, (window_.max.y - p.y) * sy});
    if (polygon.values.empty())
      fill_polygon(raster, points, polygon.colour);
    else
      fill_field_polygon(raster, points, polygon.values, contents_.range.low, contents_.range.high,
                         picture_.map);
  }
  canvas.image(format == PictureFormat::kPng ? raster.reduced(kSamplesPerPixel) : raster, box);
}

void SliceDrawing::draw_panel(Canvas& canvas, std::size_t index, PictureFormat format) const {
  const SlicePanel& panel = picture_.panels[index];
  const Box2 box = panel_box(index);
  draw_areas(canvas, panel, box, format);
  const AxisScale x_scale{window_.min.x, window_.max.x, box.min.x, box.max.x};
  const AxisScale y_scale{window_.min.y, window_.max.y, box.max.y, box.min.y};
  canvas.clip(box);
  for (const LineSet& lines : panel.lines) {
    std::vector<Vec2> ends;
    for (const auto& [a, b] : shown_segments(lines.points, window_)) {
      ends.push_back({x_scale.at(a.x), y_scale.at(a.y)});
      ends.push_back({x_scale.at(b.x), y_scale.at(b.y)});
    }
    Stroke stroke = lines.stroke;
    stroke.width *= stroke_scale_;
    for (double& dash : stroke.dashes) dash *= stroke_scale_;
    canvas.segments(ends, stroke);
  }
  canvas.unclip();
  const std::array<Vec2, 4> frame{box.min, Vec2{box.max.x, box.min.y}, box.max, Vec2{box.min.x, box.max.y}};
  canvas.polyline(frame, {.colour = kFrame, .width = 0.06 * font_}, true);
  if (shown_.numbers) {
    draw_x_axis(canvas, box, x_scale, x_ticks_, label(picture_.x_label), font_);
    if (index == 0)
      draw_y_axis(canvas, box, y_scale, y_ticks_, label(picture_.y_label), label_distance_, font_);
  }
  const TextStyle style{.size = font_, .colour = kInk};
  canvas.text(shortened(panel.title, style, panel_size_.x + 0.8 * gap_),
              {box.min.x, box.min.y - 0.55 * font_}, style);
}

void SliceDrawing::draw_bar(Canvas& canvas) const {
  const double f = font_;
  const Box2 last = panel_box(picture_.panels.size() - 1);
  const double tip = 0.9 * f, x = std::ceil(last.max.x + f);
  const Box2 bar{{x, last.min.y + (contents_.above ? tip : 0)},
                 {x + kBarWidth * f, last.max.y - (contents_.below ? tip : 0)}};
  const int rows = std::clamp(static_cast<int>(bar.size().y), 2, 1024);
  Raster raster(1, rows);
  for (int y = 0; y < rows; ++y) raster.set(0, y, picture_.map.at(1 - (y + 0.5) / rows));
  canvas.image(raster, bar);
  const double middle = 0.5 * (bar.min.x + bar.max.x);
  std::vector<Vec2> outline{{bar.min.x, bar.max.y}, {bar.min.x, bar.min.y}};
  if (contents_.above) {
    const Vec2 top{middle, bar.min.y - tip};
    canvas.fill(std::array{bar.min, top, Vec2{bar.max.x, bar.min.y}}, picture_.map.at(1));
    outline.push_back(top);
  }
  outline.push_back({bar.max.x, bar.min.y});
  outline.push_back(bar.max);
  if (contents_.below) {
    const Vec2 bottom{middle, bar.max.y + tip};
    canvas.fill(std::array{Vec2{bar.min.x, bar.max.y}, bottom, bar.max}, picture_.map.at(0));
    outline.push_back(bottom);
  }
  const Stroke stroke{.colour = kFrame, .width = 0.06 * f};
  canvas.polyline(outline, stroke, true);

  const AxisScale scale{contents_.range.low, contents_.range.high, bar.max.y, bar.min.y};
  for (std::size_t i = 0; i < bar_ticks_.positions.size(); ++i) {
    const double y = scale.at(bar_ticks_.positions[i]);
    canvas.polyline(std::array{Vec2{bar.max.x, y}, Vec2{bar.max.x + kTickLength * f, y}}, stroke);
    canvas.text(bar_ticks_.labels[i], {bar.max.x + (kTickLength + kTickGap) * f, y + 0.36 * kTickFont * f},
                {.size = kTickFont * f, .colour = kInk});
  }
  const double label_x = bar.max.x + (kTickLength + kTickGap + 1.4) * f + bar_label_width_;
  const TextStyle style{.size = f, .colour = kInk};
  canvas.text(shortened(label(picture_.field_label), style, last.size().y),
              {label_x, 0.5 * (last.min.y + last.max.y)}, style, Anchor::kMiddle, 90);
}

void SliceDrawing::draw_on(Canvas& canvas, PictureFormat format) const {
  const TextStyle title{.size = kTitleFont * font_, .colour = kInk, .bold = true};
  canvas.text(shortened(picture_.title, title, width_ - 2 * kMargin * font_),
              {kMargin * font_, (kMargin + kTitleFont) * font_}, title);
  for (std::size_t i = 0; i < picture_.panels.size(); ++i) draw_panel(canvas, i, format);
  if (shown_.bar) draw_bar(canvas);
  legend_.draw(canvas, {kMargin * font_, height_ - kMargin * font_ - legend_.height()});
}

std::string SliceDrawing::draw(PictureFormat format) const {
  Canvas canvas(format, width_, height_);
  draw_on(canvas, format);
  return canvas.finish(picture_.title);
}

Raster SliceDrawing::frame() const {
  Canvas canvas(PictureFormat::kPng, width_, height_);
  draw_on(canvas, PictureFormat::kPng);
  return canvas.pixels();
}

}  // namespace

Stroke cell_stroke() { return {.colour = {0.1, 0.1, 0.12}, .width = 0.7, .opacity = 0.35}; }
Stroke original_interface_stroke() { return {.colour = {0.05, 0.05, 0.05}, .width = 2.4}; }
Stroke approximated_interface_stroke() { return {.colour = {0.86, 0.08, 0.24}, .width = 2.0}; }

std::string draw_slice(const SlicePicture& picture, PictureFormat format, const SliceOptions& options) {
  return SliceDrawing(picture, options).draw(format);
}

Raster draw_slice_frame(const SlicePicture& picture, const SliceOptions& options) {
  return SliceDrawing(picture, options).frame();
}

void write_slice(const SlicePicture& picture, const std::filesystem::path& path,
                 const SliceOptions& options) {
  write_bytes(path, draw_slice(picture, picture_format(path), options));
}

}  // namespace adamas::picture
