#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/picture/vec2.h"

namespace adamas::picture {

/// Visits the pixels (x, y) of a width x height grid whose centres (x + 1/2, y + 1/2) lie in a convex
/// polygon, row by row: visit(int x, int y). Centres on an edge belong to the polygon on its right (in a row,
/// to the half-open interval from the left to the right crossing), and a crossing depends only on the edge,
/// not on its direction, so polygons that share an edge neither omit nor share a pixel. The polygon may have
/// either orientation; coordinates must be finite. With a `tolerance`, centres that far outside belong to it
/// too, so that no gaps appear between polygons of which one has more points on their common edge, which
/// round-off moves off it.
template <class Visit>
void scan_convex_polygon(std::span<const Vec2> points, int width, int height, Visit&& visit,
                         double tolerance = 0) {
  if (points.size() < 3) return;
  double low = points[0].y, high = points[0].y;
  for (const Vec2& p : points) low = std::min(low, p.y), high = std::max(high, p.y);
  const auto pixel = [](double at, int count) {
    return static_cast<int>(std::clamp(std::ceil(at - 0.5), 0.0, static_cast<double>(count)));
  };
  const int first_row = pixel(low - tolerance, height), last_row = pixel(high + tolerance, height);
  // A row that touches the polygon from above or below gets its first or its last part.
  const double last = std::max(low, std::nextafter(high, low));
  for (int y = first_row; y < last_row; ++y) {
    const double centre = std::clamp(y + 0.5, low, last);
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (std::size_t i = 0; i < points.size(); ++i) {
      Vec2 a = points[i], b = points[i + 1 < points.size() ? i + 1 : 0];
      if ((a.y <= centre) == (b.y <= centre)) continue;
      if (a.y > b.y) std::swap(a, b);
      const double x = a.x + (centre - a.y) * ((b.x - a.x) / (b.y - a.y));
      left = std::min(left, x);
      right = std::max(right, x);
    }
    if (!(left < right)) continue;
    const int begin = pixel(left - tolerance, width), end = pixel(right + tolerance, width);
    for (int x = begin; x < end; ++x) visit(x, y);
  }
}

}  // namespace adamas::picture
