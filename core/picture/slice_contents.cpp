#include "core/picture/slice_contents.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/picture/axes.h"

namespace adamas::picture {
namespace {

void check_points(const std::vector<Vec2>& points) {
  for (const Vec2& p : points) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y))
      fail("slice picture: expected finite coordinates, found ({}, {})", p.x, p.y);
  }
}

bool before(const Vec2& a, const Vec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

}  // namespace

SliceContents survey_slice(const SlicePicture& picture) {
  if (picture.panels.empty()) fail("slice picture: expected at least one panel, found none");
  SliceContents contents;
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (const SlicePanel& panel : picture.panels) {
    for (const FieldPolygon& polygon : panel.polygons) {
      check_points(polygon.points);
      for (const Vec2& p : polygon.points) contents.window.extend(p);
      if (polygon.values.empty()) continue;
      if (polygon.values.size() != polygon.points.size()) {
        fail("slice picture: expected a value for each of {} corners, found {}", polygon.points.size(),
             polygon.values.size());
      }
      contents.has_field = true;
      for (const double v : polygon.values) {
        if (!std::isfinite(v))
          contents.has_missing = true;
        else
          least = std::min(least, v), greatest = std::max(greatest, v);
      }
    }
    for (const LineSet& lines : panel.lines) {
      check_points(lines.points);
      for (const Vec2& p : lines.points) contents.window.extend(p);
    }
  }
  if (!(least <= greatest)) least = 0, greatest = 1;
  contents.range = picture.range.value_or(ValueRange{least, greatest});
  if (!(std::isfinite(contents.range.low) && std::isfinite(contents.range.high) &&
        contents.range.low <= contents.range.high)) {
    fail("slice picture: expected a finite range, found {} to {}", contents.range.low, contents.range.high);
  }
  contents.below = least<contents.range.low, contents.above = greatest> contents.range.high;
  if (picture.window) contents.window = *picture.window;
  check_points({contents.window.empty() ? Vec2{} : contents.window.min,
                contents.window.empty() ? Vec2{} : contents.window.max});
  return contents;
}

Box2 shown_window(const Box2& window) {
  constexpr double kGreatestRatio = 8;
  if (window.empty()) return {{0, 0}, {1, 1}};
  const Vec2 middle = 0.5 * (window.min + window.max), size = window.size();
  const double longest = std::max(size.x, size.y);
  const double least = longest > 0 ? longest / kGreatestRatio : 1;
  const Vec2 half{0.5 * std::max(size.x, least), 0.5 * std::max(size.y, least)};
  return {middle - half, middle + half};
}

std::vector<std::array<Vec2, 2>> shown_segments(const std::vector<Vec2>& points, const Box2& window) {
  std::vector<std::array<Vec2, 2>> segments;
  for (std::size_t k = 0; k + 1 < points.size(); k += 2) {
    Vec2 a = points[k], b = points[k + 1];
    if (before(b, a)) std::swap(a, b);
    if (clip_segment(window, a, b)) segments.push_back({a, b});
  }
  std::sort(segments.begin(), segments.end(), [](const auto& p, const auto& q) {
    return p[0] == q[0] ? before(p[1], q[1]) : before(p[0], q[0]);
  });
  segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
  return segments;
}

}  // namespace adamas::picture
