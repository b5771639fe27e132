#include "core/picture/interface_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/picture/axes.h"
#include "core/picture/turning_picture.h"

namespace adamas::picture {

using namespace figure_style;

namespace {

constexpr double kLightestEdgeShare = 0.5;

Box3 framed_box(const InterfacePicture& picture) {
  Box3 box = picture.domain;
  if (box.min.x <= box.max.x) return box;
  for (const PictureTriangle& triangle : picture.triangles) {
    for (const Vec3& p : triangle.points) box.extend(p);
  }
  if (!(box.min.x <= box.max.x)) return {{0, 0, 0}, {1, 1, 1}};
  return box;
}

/// The legend of the colours that are visible, found by drawing a picture of half the size.
std::vector<LegendEntry> visible_materials(const InterfacePicture& picture, const Box3& shown,
                                           const InterfacePictureOptions& options) {
  const int width = static_cast<int>(options.width / 2), height = static_cast<int>(options.height / 2);
  Rasteriser rasteriser(Camera(picture.projection, shown, picture.direction, width, height), width, height);
  rasteriser.draw(picture.triangles);
  std::set<std::array<double, 3>> colours;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::uint32_t triangle = rasteriser.triangle_at(x, y);
      if (triangle == Rasteriser::kNone) continue;
      const Colour& c = rasteriser.facing_colour(triangle);
      colours.insert({c.r, c.g, c.b});
    }
  }
  std::vector<LegendEntry> entries = picture.materials;
  std::erase_if(entries, [&](const LegendEntry& e) {
    return e.area && !colours.contains({e.colour.r, e.colour.g, e.colour.b});
  });
  return entries;
}

void draw_box(const Rasteriser& rasteriser, Raster& raster, const Camera& camera, const Box3& box,
              double width) {
  unsigned farthest = 0;
  for (unsigned i = 1; i < 8; ++i) {
    if (camera.distance_of(box.corner(i)) > camera.distance_of(box.corner(farthest))) farthest = i;
  }
  for (const bool hidden : {true, false}) {  // the three edges at the back first
    for (unsigned i = 0; i < 8; ++i) {
      for (unsigned bit = 1; bit < 8; bit *= 2) {
        const bool back = i == farthest || (i ^ bit) == farthest;
        if ((i & bit) != 0 || back != hidden) continue;
        const Colour colour = back ? mix(kFrame, {1, 1, 1}, kLightestEdgeShare) : kFrame;
        rasteriser.draw_line(raster, box.corner(i), box.corner(i | bit), width, colour);
      }
    }
  }
}

void draw_axes(Canvas& canvas, const Camera& camera, const Vec2& centre, double font_size) {
  static constexpr std::array<Colour, 3> kColours{
      {{0.75, 0.15, 0.15}, {0.10, 0.50, 0.20}, {0.12, 0.30, 0.70}}};
  static constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  std::array<int, 3> order{0, 1, 2};
  const auto axis = [](int i) { return Vec3{i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0}; };
  // The axes are drawn from the farthest to the nearest.
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return dot(axis(i), camera.forward()) > dot(axis(j), camera.forward()); });
  for (const int i : order) {
    const Vec2 flat{dot(axis(i), camera.right()), -dot(axis(i), camera.up())};
    const auto k = static_cast<std::size_t>(i);
    canvas.polyline(std::array{centre, centre + 2.4 * font_size * flat},
                    {.colour = kColours[k], .width = 0.12 * font_size});
    const double length = norm(flat);
    if (length < 0.15) continue;
    const Vec2 tip = centre + (2.4 + 0.65 / length) * font_size * flat;
    canvas.text(kNames[k], {tip.x, tip.y + 0.3 * font_size}, {.size = font_size, .colour = kColours[k]},
                Anchor::kMiddle);
  }
}

/// Draws text in a white box.
void draw_message(Canvas& canvas, const std::string& text, const Vec2& centre, double font_size) {
  const TextStyle style{.size = font_size, .colour = kInk};
  const std::string shown = shortened(text, style, 1.8 * centre.x);
  const Vec2 half{0.5 * text_width(shown, style) + 0.5 * font_size, font_size};
  canvas.fill_box({centre - half, centre + half}, {1, 1, 1});
  canvas.text(shown, {centre.x, centre.y + 0.35 * font_size}, style, Anchor::kMiddle);
}

}  // namespace

std::string draw_interfaces(const InterfacePicture& picture, PictureFormat format,
                            const InterfacePictureOptions& options) {
  const double f = options.font_size > 0 ? options.font_size : std::max(options.width / 70, kLeastFont);
  if (!(options.width >= 100 && options.width <= 8000 && options.height >= 100 && options.height <= 8000 &&
        options.samples >= 1 && options.samples <= 4 && options.font_size <= options.width / 10)) {
    fail(
        "interface picture: expected sides of 100 to 8000 and 1 to 4 samples, found {} x {}, {} samples, "
        "font size {}",
        options.width, options.height, options.samples, options.font_size);
  }
  Canvas canvas(format, options.width, options.height);
  const Box3 box = framed_box(picture), shown = picture.focus.value_or(box);
  const Legend legend(visible_materials(picture, shown, options), options.width - 2 * kMargin * f, f);
  const double top = std::ceil((0.5 * kMargin + (picture.title.empty() ? 0 : kTitleHeight)) * f);
  const double bottom = std::ceil(legend.height() + (legend.height() > 0 ? 1.5 : 0.5) * kMargin * f);
  const int width = static_cast<int>(options.width), height = static_cast<int>(options.height - top - bottom);
  if (height < 4 * f)
    fail("interface picture: expected room for the picture, found a height of {}", options.height);

  const int samples = options.samples;
  const Camera camera(picture.projection, shown, picture.direction, samples * width, samples * height);
  Rasteriser rasteriser(camera, samples * width, samples * height);
  rasteriser.draw(picture.triangles, picture.normals);
  RasteriserStyle style{.triangle_edges = options.triangle_edges, .outlines = options.outlines};
  style.crease_angle = options.crease_angle;
  style.edge_width = samples * options.width / 1600;
  style.depth_jump = 0.02 * box.diagonal();
  Raster raster = rasteriser.shade(style);
  const bool has_domain = picture.domain.min.x <= picture.domain.max.x;
  if (has_domain) draw_box(rasteriser, raster, camera, box, std::max(1.0, 0.07 * f * samples));
  const double left = std::floor(0.5 * (options.width - width));
  canvas.image(raster.reduced(samples), {{left, top}, {left + width, top + height}});

  const TextStyle title{.size = kTitleFont * f, .colour = kInk, .bold = true};
  canvas.text(shortened(picture.title, title, options.width - 2 * kMargin * f),
              {kMargin * f, (kMargin + kTitleFont) * f}, title);
  if (!picture.message.empty())
    draw_message(canvas, picture.message, {0.5 * options.width, top + 0.5 * height}, f);
  if (options.axes) draw_axes(canvas, camera, {(kMargin + 3.2) * f, top + height - 3.2 * f}, f);
  legend.draw(canvas, {kMargin * f, options.height - kMargin * f - legend.height()});
  return canvas.finish(picture.title);
}

void write_interfaces(const InterfacePicture& picture, const std::filesystem::path& path,
                      const InterfacePictureOptions& options) {
  write_bytes(path, lower_extension(path) == ".html"
                        ? turning_page(picture)
                        : draw_interfaces(picture, picture_format(path), options));
}

}  // namespace adamas::picture
