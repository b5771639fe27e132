#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/picture/colour.h"
#include "core/picture/colour_map.h"
#include "core/picture/vec2.h"

namespace adamas::picture {

/// A grid of pixels with colour and opacity, row 0 on top. Pixel (x, y) covers [x, x+1) x [y, y+1).
class Raster {
 public:
  /// A pixel with components 0..255; `a` is the opacity, which is not multiplied into the others.
  struct Pixel {
    std::uint8_t r = 0, g = 0, b = 0, a = 0;
    bool operator==(const Pixel&) const = default;
  };

  /// Makes a raster of transparent pixels. Throws Error unless both sides are in 1..32767.
  Raster(int width, int height);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const Pixel& at(int x, int y) const { return pixels_[index(x, y)]; }
  [[nodiscard]] Pixel& at(int x, int y) { return pixels_[index(x, y)]; }
  void set(int x, int y, const Colour& colour);

  /// Averages blocks of factor x factor pixels; sides that are no multiple are padded with transparent
  /// pixels.
  [[nodiscard]] Raster reduced(int factor) const;

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_, height_;
  std::vector<Pixel> pixels_;
};

/// A linear function in the plane, clamped to the values it was fitted to.
struct LinearField {
  Vec2 origin, gradient;
  double value = 0, least = 0, greatest = 0;

  /// Fits a function to values at the corners of a polygon over which a field is linear, by the corners of
  /// the greatest triangle among them. A polygon without area gets the mean everywhere.
  static LinearField fit(std::span<const Vec2> points, std::span<const double> values);
  [[nodiscard]] double at(const Vec2& p) const;
};

/// Fills a convex polygon, in pixel coordinates, with one colour.
void fill_polygon(Raster& raster, std::span<const Vec2> points, const Colour& colour);

/// Fills a convex polygon, in pixel coordinates, with the colours of a field that is linear over it,
/// evaluated at the pixel centres; `low` and `high` get the colours at the ends of the map. A polygon with a
/// NaN value gets the colour `no_data`.
void fill_field_polygon(Raster& raster, std::span<const Vec2> points, std::span<const double> values,
                        double low, double high, const ColourMap& map);

}  // namespace adamas::picture
