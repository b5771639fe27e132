#include "core/picture/raster.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/picture/scan_convex.h"

namespace adamas::picture {
namespace {

constexpr int kGreatestSide = 32767;
/// A distance in pixels that exceeds the round-off of coordinates and is invisible.
constexpr double kSeam = 1e-6;

std::uint8_t rounded_mean(std::uint64_t sum, std::uint64_t count) {
  return static_cast<std::uint8_t>(count > 0 ? (2 * sum + count) / (2 * count) : 0);
}

}  // namespace

Raster::Raster(int width, int height) : width_(width), height_(height) {
  if (width < 1 || height < 1 || width > kGreatestSide || height > kGreatestSide) {
    fail("picture: expected sides of 1 to {} pixels, found {} x {}", kGreatestSide, width, height);
  }
  pixels_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

void Raster::set(int x, int y, const Colour& colour) {
  const auto bytes = to_bytes(colour);
  at(x, y) = {bytes[0], bytes[1], bytes[2], 255};
}

Raster Raster::reduced(int factor) const {
  ADAMAS_ASSERT(factor >= 1);
  Raster result((width_ + factor - 1) / factor, (height_ + factor - 1) / factor);
  for (int y = 0; y < result.height_; ++y) {
    for (int x = 0; x < result.width_; ++x) {
      std::uint64_t r = 0, g = 0, b = 0, a = 0;
      for (int v = y * factor; v < std::min((y + 1) * factor, height_); ++v) {
        for (int u = x * factor; u < std::min((x + 1) * factor, width_); ++u) {
          const Pixel& p = at(u, v);
          const std::uint64_t weight = p.a;
          r += weight * p.r, g += weight * p.g, b += weight * p.b, a += weight;
        }
      }
      result.at(x, y) = {
          rounded_mean(r, a), rounded_mean(g, a), rounded_mean(b, a),
          rounded_mean(a, static_cast<std::uint64_t>(factor) * static_cast<std::uint64_t>(factor))};
    }
  }
  return result;
}

LinearField LinearField::fit(std::span<const Vec2> points, std::span<const double> values) {
  ADAMAS_ASSERT(!points.empty() && points.size() == values.size());
  LinearField field;
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  field.least = *least, field.greatest = *greatest;
  field.origin = points[0];
  // i is the farthest corner from the first, j the farthest from the line through both.
  std::size_t i = 0, j = 0;
  double reach = 0, area = 0;
  for (std::size_t k = 1; k < points.size(); ++k) {
    if (const double d = norm(points[k] - points[0]); d > reach) reach = d, i = k;
  }
  for (std::size_t k = 1; k < points.size(); ++k) {
    const double a = cross(points[i] - points[0], points[k] - points[0]);
    if (std::abs(a) > std::abs(area)) area = a, j = k;
  }
  if (!(std::abs(area) > 1e-12 * reach * reach)) {
    field.value = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    return field;
  }
  const Vec2 u = points[i] - points[0], v = points[j] - points[0];
  const double du = values[i] - values[0], dv = values[j] - values[0];
  field.value = values[0];
  field.gradient = {(du * v.y - dv * u.y) / area, (dv * u.x - du * v.x) / area};
  return field;
}

double LinearField::at(const Vec2& p) const {
  return std::clamp(value + dot(gradient, p - origin), least, greatest);
}

void fill_polygon(Raster& raster, std::span<const Vec2> points, const Colour& colour) {
  const auto bytes = to_bytes(colour);
  const Raster::Pixel pixel{bytes[0], bytes[1], bytes[2], 255};
  scan_convex_polygon(
      points, raster.width(), raster.height(), [&](int x, int y) { raster.at(x, y) = pixel; }, kSeam);
}

void fill_field_polygon(Raster& raster, std::span<const Vec2> points, std::span<const double> values,
                        double low, double high, const ColourMap& map) {
  ADAMAS_ASSERT(points.size() == values.size());
  if (points.size() < 3) return;
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
    fill_polygon(raster, points, ColourMap::no_data());
    return;
  }
  const LinearField field = LinearField::fit(points, values);
  const double scale = high > low ? 1 / (high - low) : 0, offset = high > low ? 0 : 0.5;
  const auto fill = [&](int x, int y) {
    raster.set(x, y, map.at(offset + scale * (field.at({x + 0.5, y + 0.5}) - low)));
  };
  scan_convex_polygon(points, raster.width(), raster.height(), fill, kSeam);
}

}  // namespace adamas::picture
