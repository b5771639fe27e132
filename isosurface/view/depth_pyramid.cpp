#include "isosurface/view/depth_pyramid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/base/assert.h"

namespace adamas::isosurface {

namespace {

/// Returns half of the width of a box along a direction.
double half_along(const Vec3& direction, const Vec3& half) {
  return std::abs(direction.x) * half.x + std::abs(direction.y) * half.y + std::abs(direction.z) * half.z;
}

}  // namespace

DepthPyramid::DepthPyramid(const Viewpoint& viewpoint, std::span<const float> depths)
    : viewpoint_(viewpoint), axes_(viewpoint) {
  const double half = viewpoint.height > 0 ? viewpoint.height / 2 : std::tan(viewpoint.field_of_view / 2);
  scale_ = 0.5 * viewpoint.height_pixels / half;
  levels_.push_back({viewpoint.width_pixels, viewpoint.height_pixels, {depths.begin(), depths.end()}});
  ADAMAS_ASSERT(depths.size() == static_cast<std::size_t>(viewpoint.width_pixels) *
                                     static_cast<std::size_t>(viewpoint.height_pixels));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
    coarse.farthest.assign(static_cast<std::size_t>(coarse.width) * static_cast<std::size_t>(coarse.height),
                           0);
    for (std::int32_t y = 0; y < fine.height; ++y) {
      const float* const from = fine.farthest.data() + static_cast<std::ptrdiff_t>(y) * fine.width;
      float* const to = coarse.farthest.data() + static_cast<std::ptrdiff_t>(y / 2) * coarse.width;
      for (std::int32_t x = 0; x < fine.width; ++x) to[x / 2] = std::max(to[x / 2], from[x]);
    }
    levels_.push_back(std::move(coarse));
  }
}

bool DepthPyramid::hides(const CentredBox& box) const {
  const Vec3 from_eye = box.centre - viewpoint_.eye;
  const double depth = dot(from_eye, axes_.forward), half_depth = half_along(axes_.forward, box.half);
  const double nearest = depth - half_depth;
  if (!(nearest > viewpoint_.near)) return false;
  // This finds the least and the greatest place of a box along an axis of the picture, in pixels from its
  // middle. The interval of a box contains those of boxes inside it.
  const auto places = [&](const Vec3& axis) {
    const double middle = dot(from_eye, axis), half = half_along(axis, box.half);
    const double low = middle - half, high = middle + half;
    if (viewpoint_.height > 0) return std::pair(scale_ * low, scale_ * high);
    const double farthest = depth + half_depth;
    return std::pair(scale_ * (low < 0 ? low / nearest : low / farthest),
                     scale_ * (high > 0 ? high / nearest : high / farthest));
  };
  const auto [left, right] = places(axes_.right);
  const auto [bottom, top] = places(axes_.up);
  const auto pixel = [](double place, std::int32_t count) {
    return static_cast<std::int32_t>(std::clamp(std::floor(place), -1.0, static_cast<double>(count)));
  };
  const std::int32_t width = viewpoint_.width_pixels, height = viewpoint_.height_pixels;
  // There is a pixel more on each side, since depths are those of the middles of pixels.
  const std::int32_t x0 = pixel(0.5 * width + left - 1, width), x1 = pixel(0.5 * width + right + 1, width),
                     y0 = pixel(0.5 * height - top - 1, height),
                     y1 = pixel(0.5 * height - bottom + 1, height);
  if (x1 < 0 || y1 < 0 || x0 >= width || y0 >= height) return true;
  const float farthest =
      farthest_in(std::max(x0, 0), std::max(y0, 0), std::min(x1, width - 1), std::min(y1, height - 1));
  return static_cast<double>(farthest) < nearest;
}

/// Visits squares of such a size that at most five by five cover the pixels: larger ones would extend far
/// beyond them.
float DepthPyramid::farthest_in(std::int32_t left, std::int32_t top, std::int32_t right,
                                std::int32_t bottom) const {
  const auto side = static_cast<std::uint32_t>(std::max(right - left, bottom - top));
  const auto n = std::min(static_cast<std::size_t>(std::bit_width(side >> 2)), levels_.size() - 1);
  const Level& level = levels_[n];
  float farthest = 0;
  for (std::int32_t y = top >> n; y <= bottom >> n; ++y) {
    for (std::int32_t x = left >> n; x <= right >> n; ++x)
      farthest = std::max(farthest,
                          level.farthest[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) +
                                         static_cast<std::size_t>(x)]);
  }
  return farthest;
}

}  // namespace adamas::isosurface
