#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "adamas/geometry.h"
#include "core/lattice/domain.h"
#include "isosurface/contour/contour.h"
#include "tests/support/table_contour.h"

namespace adamas::test {

using namespace isosurface;

Domain unit_domain(std::array<int, 3> roots);

/// Splits all diamonds with tetrahedra in the mesh, `generations` times. Returns what was split, parents
/// first.
std::vector<LatticePoint> refine(IndexedHierarchy& hierarchy, int generations);
/// Splits diamonds at random.
void refine_randomly(IndexedHierarchy& hierarchy, unsigned seed, int steps);

/// Returns a number in [0, 1) for each point and seed.
double random_value(LatticePoint p, unsigned seed);

/// Returns the edges with one triangle. Fails the test unless all other edges have two triangles that run
/// along them in opposite directions.
std::vector<std::array<std::uint32_t, 2>> border_edges(const Contour& contour);
/// Expects that edges with one triangle lie in the sides of the box, and all points in the box.
void expect_closed(const Contour& contour, const Box3& box);

/// Returns the Euler characteristic of each connected component of a surface, in ascending order. Fails the
/// test where the triangles at a point are not exactly one fan.
std::vector<int> topology(const Contour& contour);

/// Integrals over a surface that do not depend on how its parts are triangulated: its area, its area vector
/// and the volume that it encloses with the origin.
struct SurfaceMeasure {
  double area = 0, volume = 0;
  Vec3 vector;

  void add(const Vec3& a, const Vec3& b, const Vec3& c);
};
SurfaceMeasure measure(const Contour& contour);
void expect_near(const SurfaceMeasure& a, const SurfaceMeasure& b, double tolerance);

/// Returns the zeros of a linear function in a tetrahedron as a convex polygon, counterclockwise seen from
/// where the function is negative. The corners are crossings of edges, ordered by angle. No value may be 0.
std::vector<Vec3> zero_polygon(const std::array<Vec3, 4>& points, const std::array<double, 4>& values);
/// Returns the volume of the part of a tetrahedron where a linear function is positive; no two values may be
/// equal.
double positive_volume(const std::array<Vec3, 4>& points, const std::array<double, 4>& values);

/// Calls fn(points, values less the isovalue) for the tetrahedra of a mesh.
template <class Values, class Fn>
void for_each_function(const IndexedHierarchy& hierarchy, const Values& values, double isovalue, Fn&& fn) {
  hierarchy.for_each_tetrahedron([&](const Diamond& diamond, int slot) {
    const auto vertices = diamond.tetrahedron(slot);
    std::array<Vec3, 4> points;
    std::array<double, 4> differences;
    for (std::size_t v = 0; v < 4; ++v) {
      points[v] = hierarchy.domain().position(vertices[v]);
      differences[v] = values(vertices[v]) - isovalue;
    }
    fn(points, differences);
  });
}

}  // namespace adamas::test
