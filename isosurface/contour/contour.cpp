#include "isosurface/contour/contour.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/lattice/diamond.h"
#include "core/lattice/lattice_map.h"
#include "isosurface/contour/contour_clip.h"
#include "isosurface/contour/point_between.h"

namespace adamas {

namespace {

/// Whether the tetrahedron has at most a face in the data's box.
bool is_beyond(const std::array<LatticePoint, 4>& vertices, LatticePoint last_sample) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::all_of(vertices.begin(), vertices.end(),
                    [&](LatticePoint p) { return p[axis] >= last_sample[axis]; })) {
      return true;
    }
  }
  return false;
}

/// Parameter of the isovalue between two finite values, one of them below it and one not.
double crossing(double first, double second, double isovalue) {
  // Differences of halves cannot overflow; those of small values lose no bits.
  const double scale = std::max(std::abs(first), std::abs(second)) > 1 ? 0.5 : 1;
  return (scale * isovalue - scale * first) / (scale * second - scale * first);
}

/// Numbers the points of edges in the order in which they are first asked for.
class EdgePoints {
 public:
  EdgePoints(const Domain& domain, double isovalue, double least_parameter, Contour& contour)
      : domain_(domain), isovalue_(isovalue), least_(least_parameter), contour_(contour) {}

  std::uint32_t at(LatticePoint a, LatticePoint b, double value_a, double value_b) {
    if (b < a) {
      std::swap(a, b);
      std::swap(value_a, value_b);
    }
    // No two edges of a mesh have the same midpoint, and midpoints are lattice points: those at which the
    // edges would be split.
    const LatticePoint way = b - a;
    const auto [index, is_new] = indices_.insert(a + LatticePoint{way.i / 2, way.j / 2, way.k / 2});
    if (is_new) {
      if (contour_.points.size() >= std::numeric_limits<std::uint32_t>::max())
        fail("a contour has more than 2^32 - 1 points: choose another isovalue or a coarser mesh");
      *index = static_cast<std::uint32_t>(contour_.points.size());
      const double t = std::clamp(crossing(value_a, value_b, isovalue_), least_, 1 - least_);
      contour_.edge_points.push_back({a, b, t});
      contour_.points.push_back(point_between(domain_.position(a), domain_.position(b), t));
    }
    return *index;
  }

 private:
  const Domain& domain_;
  double isovalue_, least_;
  Contour& contour_;
  LatticeMap<std::uint32_t> indices_;
};

}  // namespace

Contour triangulate_crossed(const Domain& domain, std::vector<CrossedTetrahedron> crossed, double isovalue,
                            const ContourOptions& options) {
  ADAMAS_ASSERT(options.least_parameter >= 0 && options.least_parameter < 0.5);
  std::sort(crossed.begin(), crossed.end(), [](const CrossedTetrahedron& a, const CrossedTetrahedron& b) {
    return std::tie(a.diamond, a.slot) < std::tie(b.diamond, b.slot);
  });
  Contour contour;
  EdgePoints edge_points(domain, isovalue, options.least_parameter, contour);
  for (const CrossedTetrahedron& t : crossed) {
    const auto is_finite = [](double value) { return std::isfinite(value); };
    if (!std::all_of(t.values.begin(), t.values.end(), is_finite)) continue;
    const std::array<LatticePoint, 4> vertices = Diamond(t.diamond).tetrahedron(t.slot);
    if (options.last_sample && is_beyond(vertices, *options.last_sample)) continue;
    const TetrahedronContour& table = kTetrahedronContours[t.above];
    for (std::size_t n = 0; n < table.triangle_count; ++n) {
      std::array<std::uint32_t, 3>& triangle = contour.triangles.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        const auto [v, w] = kTetrahedronEdges[table.triangles[n][c]];
        triangle[c] = edge_points.at(vertices[v], vertices[w], t.values[v], t.values[w]);
      }
    }
  }
  if (options.last_sample) clip_contour(contour, domain.position(*options.last_sample));
  return contour;
}

}  // namespace adamas
