#include "tests/isosurface/surface_checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/geometry/tetrahedron_contour.h"
#include "tests/isosurface/contour_checks.h"

namespace adamas::test {

using namespace isosurface;

namespace {

/// The vertices of a tetrahedron in any order.
using Corners = std::array<LatticePoint, 4>;

LatticePoint middle_of(LatticePoint a, LatticePoint b) {
  const LatticePoint sum = a + b;
  return {sum.i / 2, sum.j / 2, sum.k / 2};
}

/// Returns the indices of the ends of the longest edge.
std::pair<std::size_t, std::size_t> longest_edge(const Corners& corners) {
  std::pair<std::size_t, std::size_t> longest{0, 1};
  std::int64_t greatest = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) {
      const LatticePoint way = corners[a] - corners[b];
      const auto square = [](std::int64_t x) { return x * x; };
      const std::int64_t length = square(way.i) + square(way.j) + square(way.k);
      if (length > greatest) longest = {a, b}, greatest = length;
    }
  }
  return longest;
}

std::array<Corners, 2> halves(const Corners& corners) {
  const auto [a, b] = longest_edge(corners);
  std::array<Corners, 2> result{corners, corners};
  result[0][b] = result[1][a] = middle_of(corners[a], corners[b]);
  return result;
}

/// Returns the diamond of the tetrahedron with these corners, which has to be one of the hierarchy.
LatticePoint diamond_of(const Corners& corners) {
  const auto [a, b] = longest_edge(corners);
  const Diamond diamond(middle_of(corners[a], corners[b]));
  Corners wanted = corners;
  std::sort(wanted.begin(), wanted.end());
  for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
    Corners found = diamond.tetrahedron(slot);
    std::sort(found.begin(), found.end());
    if (found == wanted) return diamond.point();
  }
  ADD_FAILURE() << "no tetrahedron of the hierarchy";
  return diamond.point();
}

/// Returns the barycentric coordinates of a point.
std::array<double, 4> weights_in(const std::array<Vec3, 4>& c, const Vec3& p) {
  const double whole = signed_volume(c[0], c[1], c[2], c[3]);
  return {signed_volume(p, c[1], c[2], c[3]) / whole, signed_volume(c[0], p, c[2], c[3]) / whole,
          signed_volume(c[0], c[1], p, c[3]) / whole, signed_volume(c[0], c[1], c[2], p) / whole};
}

}  // namespace

TriangleSet triangle_set(const Contour& contour) {
  EXPECT_TRUE(contour.mean_points.empty());
  TriangleSet set;
  for (const auto& triangle : contour.triangles) {
    std::array<Edge, 3> edges;
    for (std::size_t c = 0; c < 3; ++c) {
      const EdgePoint& p = contour.edge_points[triangle[c]];
      edges[c] = {p.first, p.second};
    }
    std::rotate(edges.begin(), std::min_element(edges.begin(), edges.end()), edges.end());
    set.insert(edges);
  }
  return set;
}

void expect_sound(const Contour& contour, const Box3& box) {
  expect_closed(contour, box);
  std::size_t flat = 0;
  for (const auto& [a, b, c] : contour.triangles) {
    const Vec3 &p = contour.points[a], &q = contour.points[b], &r = contour.points[c];
    const double area = norm(cross(q - p, r - p));
    const bool at_border = std::max({a, b, c}) >= contour.edge_points.size();
    flat += at_border ? !(area >= 0) : !(area > 1e-9 * squared_norm(q - p));
  }
  EXPECT_EQ(flat, 0u) << "triangles without an area";
  std::vector<bool> used(contour.points.size());
  for (const auto& triangle : contour.triangles) {
    for (const std::uint32_t p : triangle) used[p] = true;
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << "points of no triangle";
}

MeshFunction::MeshFunction(const IndexedHierarchy& mesh, Field values)
    : mesh_(mesh), values_(std::move(values)) {}

MeshFunction::Place MeshFunction::at(const Vec3& point) const {
  const Domain& domain = mesh_.domain();
  const auto place = [&](const Corners& corners) {
    std::array<Vec3, 4> result;
    for (std::size_t v = 0; v < 4; ++v) result[v] = domain.position(corners[v]);
    return weights_in(result, point);
  };
  const auto inside = [&](const Corners& corners) {
    const auto weights = place(corners);
    return *std::min_element(weights.begin(), weights.end());
  };
  const std::int32_t middle = std::int32_t{1} << (kRootBits - 1);
  const Diamond root({middle, middle, middle});
  Corners corners = root.tetrahedron(0);
  for (int slot = 1; slot < root.tetrahedron_count(); ++slot) {
    if (inside(root.tetrahedron(slot)) > inside(corners)) corners = root.tetrahedron(slot);
  }
  LatticePoint diamond = diamond_of(corners);
  while (mesh_.is_split(diamond)) {
    const auto both = halves(corners);
    corners = inside(both[0]) >= inside(both[1]) ? both[0] : both[1];
    diamond = diamond_of(corners);
  }
  const auto weights = place(corners);
  Place result{diamond, 0};
  for (std::size_t v = 0; v < 4; ++v) result.value += weights[v] * values_(corners[v]);
  return result;
}

std::vector<Vec3> points_on(const Contour& contour) {
  std::vector<Vec3> points = contour.points;
  for (const auto& [a, b, c] : contour.triangles) {
    const Vec3 &p = contour.points[a], &q = contour.points[b], &r = contour.points[c];
    points.push_back(1.0 / 3 * (p + q + r));
    points.push_back(0.5 * (p + q));
    points.push_back(0.7 * p + 0.2 * q + 0.1 * r);
  }
  return points;
}

}  // namespace adamas::test
