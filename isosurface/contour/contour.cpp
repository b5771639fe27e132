#include "isosurface/contour/contour.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/lattice/diamond.h"
#include "isosurface/contour/contour_clip.h"
#include "isosurface/contour/point_between.h"

namespace adamas {

namespace {

/// Parameter of the isovalue between two finite values, one of them below it and one not.
double crossing(double first, double second, double isovalue) {
  // Differences of halves cannot overflow; those of small values lose no bits.
  const double scale = std::max(std::abs(first), std::abs(second)) > 1 ? 0.5 : 1;
  return (scale * isovalue - scale * first) / (scale * second - scale * first);
}

}  // namespace

bool is_beyond(const std::array<LatticePoint, 4>& vertices, LatticePoint last_sample) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::all_of(vertices.begin(), vertices.end(),
                    [&](LatticePoint p) { return p[axis] >= last_sample[axis]; })) {
      return true;
    }
  }
  return false;
}

ContourBuilder::ContourBuilder(const Domain& domain, double isovalue, const ContourOptions& options)
    : domain_(domain), isovalue_(isovalue), options_(options) {
  ADAMAS_ASSERT(options.least_parameter >= 0 && options.least_parameter < 0.5);
}

std::uint32_t ContourBuilder::edge_point(LatticePoint a, LatticePoint b, double value_a, double value_b) {
  if (b < a) {
    std::swap(a, b);
    std::swap(value_a, value_b);
  }
  // No two edges of a mesh have the same midpoint, and midpoints are lattice points: those at which the
  // edges would be split.
  const LatticePoint way = b - a;
  const auto [number, is_new] = numbers_.insert(a + LatticePoint{way.i / 2, way.j / 2, way.k / 2});
  if (is_new) {
    if (contour_.points.size() >= std::numeric_limits<std::uint32_t>::max())
      fail("a contour has more than 2^32 - 1 points: choose another isovalue or a coarser mesh");
    *number = static_cast<std::uint32_t>(contour_.points.size());
    const double t = std::clamp(crossing(value_a, value_b, isovalue_), options_.least_parameter,
                                1 - options_.least_parameter);
    contour_.edge_points.push_back({a, b, t});
    contour_.points.push_back(point_between(domain_.position(a), domain_.position(b), t));
  }
  return *number;
}

void ContourBuilder::add(const CrossedTetrahedron& t) {
  const auto is_finite = [](double value) { return std::isfinite(value); };
  if (!std::all_of(t.values.begin(), t.values.end(), is_finite)) return;
  const std::array<LatticePoint, 4> vertices = Diamond(t.diamond).tetrahedron(t.slot);
  if (options_.last_sample && is_beyond(vertices, *options_.last_sample)) return;
  const TetrahedronContour& table = kTetrahedronContours[t.above];
  for (std::size_t n = 0; n < table.triangle_count; ++n) {
    std::array<std::uint32_t, 3>& triangle = contour_.triangles.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [v, w] = kTetrahedronEdges[table.triangles[n][c]];
      triangle[c] = edge_point(vertices[v], vertices[w], t.values[v], t.values[w]);
    }
  }
}

Contour ContourBuilder::finish() {
  if (options_.last_sample)
    clip_contour(contour_, {domain_.box().min, domain_.position(*options_.last_sample)});
  return std::move(contour_);
}

Contour triangulate_crossed(const Domain& domain, std::vector<CrossedTetrahedron> crossed, double isovalue,
                            const ContourOptions& options) {
  std::sort(crossed.begin(), crossed.end(), [](const CrossedTetrahedron& a, const CrossedTetrahedron& b) {
    return std::tie(a.diamond, a.slot) < std::tie(b.diamond, b.slot);
  });
  ContourBuilder builder(domain, isovalue, options);
  for (const CrossedTetrahedron& t : crossed) builder.add(t);
  return builder.finish();
}

}  // namespace adamas
