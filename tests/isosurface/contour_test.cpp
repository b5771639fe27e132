#include "isosurface/contour/contour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "core/geometry/tetrahedron_contour.h"
#include "tests/isosurface/contour_checks.h"
#include "tests/support/closed_surface.h"

namespace adamas {

using namespace isosurface;
using test::IndexedHierarchy;

namespace {

using test::random_value;
using Field = std::function<double(LatticePoint)>;

/// Returns random values that fall below all isovalues of the tests at the sides of the domain.
Field enclosed(const Domain& domain, unsigned seed) {
  return [&domain, seed](LatticePoint p) {
    return random_value(p, seed) - (domain.boundary_count(p) > 0 ? 2 : 0);
  };
}

/// Returns the measure of the polygons of all tetrahedra, which are found without the contour's table.
test::SurfaceMeasure soup(const IndexedHierarchy& h, const Field& values, double isovalue) {
  test::SurfaceMeasure sum;
  test::for_each_function(h, values, isovalue, [&](const auto& points, const auto& differences) {
    if (std::any_of(differences.begin(), differences.end(), [](double d) { return !std::isfinite(d); }))
      return;
    const std::vector<Vec3> polygon = test::zero_polygon(points, differences);
    for (std::size_t c = 2; c < polygon.size(); ++c) sum.add(polygon[0], polygon[c - 1], polygon[c]);
  });
  return sum;
}

TEST(TetrahedronContour, IsThePolygonOfEveryCase) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(0.1, 1);
  for (unsigned above = 0; above < 16; ++above) {
    const TetrahedronContour& contour = kTetrahedronContours[above];
    const int count = std::popcount(above);
    EXPECT_EQ(contour.triangle_count, count % 4 == 0 ? 0 : count == 2 ? 2 : 1);
    for (int example = 0; example < 50; ++example) {
      std::array<Vec3, 4> points;
      std::array<double, 4> values;
      for (std::size_t v = 0; v < 4; ++v) {
        points[v] = {number(random), number(random), number(random)};
        values[v] = (above >> v & 1) != 0 ? number(random) : -number(random);
      }
      if (signed_volume(points[0], points[1], points[2], points[3]) < 0) {
        points[0] = 2 * points[1] - points[0];  // to the other side of the opposite face
      }
      const auto at = [&](std::uint8_t edge) {
        const auto [v, w] = kTetrahedronEdges[edge];
        EXPECT_NE(above >> v & 1, above >> w & 1);
        const double t = values[v] / (values[v] - values[w]);
        return (1 - t) * points[v] + t * points[w];
      };
      test::SurfaceMeasure found, wanted;
      for (std::size_t n = 0; n < contour.triangle_count; ++n) {
        const auto [a, b, c] = contour.triangles[n];
        found.add(at(a), at(b), at(c));
        const Vec3 normal = cross(at(b) - at(a), at(c) - at(a));
        for (std::size_t v = 0; v < 4; ++v)
          EXPECT_EQ(dot(points[v] - at(a), normal) < 0, (above >> v & 1) != 0);
      }
      const std::vector<Vec3> polygon = test::zero_polygon(points, values);
      for (std::size_t c = 2; c < polygon.size(); ++c) wanted.add(polygon[0], polygon[c - 1], polygon[c]);
      test::expect_near(found, wanted, 1e-13);
    }
  }
}

struct MeshCase {
  std::array<int, 3> roots;
  int generations;   ///< generations of uniform refinement
  int random_steps;  ///< random splits afterwards
};

class ContourLaws : public testing::TestWithParam<MeshCase> {
 protected:
  Domain domain = test::unit_domain(GetParam().roots);
  IndexedHierarchy h{domain, 6};
  void SetUp() override {
    test::refine(h, GetParam().generations);
    test::refine_randomly(h, 5, GetParam().random_steps);
  }
  Contour checked(const Field& values, double isovalue, double least_parameter = 0) const {
    const Contour contour = extract_contour(h, values, isovalue, {least_parameter, {}});
    test::expect_closed(contour, domain.box());
    EXPECT_TRUE(contour.mean_points.empty());
    return contour;
  }
  /// Returns the volume above the isovalue: that part is closed by the sides of the domain.
  double volume_above(const Contour& contour, const Field& values, double isovalue) const {
    std::vector<test::SidedTriangle> triangles;
    for (const auto& t : contour.triangles) triangles.push_back({t, 1, 0});
    const std::uint32_t corner = values(domain.extent()) >= isovalue ? 0 : 1;
    return test::enclosed_volumes(contour.points, triangles, 2, domain.box(), corner, 0)[0];
  }
  void expect_the_soup(const Field& values, double isovalue) const {
    const Contour contour = checked(values, isovalue);
    test::expect_near(test::measure(contour), soup(h, values, isovalue), 1e-11);
    double volume = 0;
    test::for_each_function(h, values, isovalue, [&](const auto& points, const auto& differences) {
      volume += test::positive_volume(points, differences);
    });
    EXPECT_NEAR(volume_above(contour, values, isovalue), volume, 1e-9);
  }
};

TEST_P(ContourLaws, RandomSamples) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Field everywhere = [&](LatticePoint p) { return random_value(p, seed); };
    expect_the_soup(everywhere, 0.5);
    EXPECT_FALSE(extract_contour(h, everywhere, 0.5).triangles.empty());
    const Field inside = enclosed(domain, seed);
    expect_the_soup(inside, -0.1);
    EXPECT_TRUE(test::border_edges(extract_contour(h, inside, 0.4)).empty());
    EXPECT_TRUE(test::border_edges(extract_contour(h, inside, 0.4, {1.0 / 1024, {}})).empty());
  }
}

TEST_P(ContourLaws, SmoothField) {
  const Field wave = [&](LatticePoint p) {
    const Vec3 x = domain.position(p);
    // A little noise makes values different where the wave is symmetric.
    return std::sin(4 * x.x + x.y) + std::cos(3 * x.y) * x.z + 0.01 * random_value(p, 1);
  };
  for (const double isovalue : {-0.3, 0.2, 0.9}) expect_the_soup(wave, isovalue);
}

TEST_P(ContourLaws, PointsAreWhereTheirEdgesSay) {
  const Field values = [](LatticePoint p) { return random_value(p, 9); };
  const Contour contour = checked(values, 0.3);
  std::set<std::pair<LatticePoint, LatticePoint>> edges;
  for (std::size_t i = 0; i < contour.points.size(); ++i) {
    const auto& [first, second, t] = contour.edge_points[i];
    ASSERT_LT(first, second);
    ASSERT_TRUE(edges.emplace(first, second).second);
    ASSERT_NEAR((1 - t) * values(first) + t * values(second), 0.3, 1e-14);
    const Vec3 wanted = (1 - t) * domain.position(first) + t * domain.position(second);
    ASSERT_LT(distance(contour.points[i], wanted), 1e-14);
  }
}

/// Many samples equal the isovalue, as in data of few bits.
TEST_P(ContourLaws, SamplesEqualToTheIsovalue) {
  const Field steps = [](LatticePoint p) { return std::floor(3 * random_value(p, 2)); };
  for (const double isovalue : {1.0, 2.0}) {
    checked(steps, isovalue);
    const Contour contour = checked(steps, isovalue, 1.0 / 1024);
    ASSERT_FALSE(contour.triangles.empty());
    double least = 1;
    for (const auto& [a, b, c] : contour.triangles) {
      const Vec3 &p = contour.points[a], &q = contour.points[b], &r = contour.points[c];
      least = std::min(least, norm(cross(q - p, r - p)));
    }
    EXPECT_GT(least, 1e-12);
    for (const EdgePoint& p : contour.edge_points) {
      ASSERT_GE(p.parameter, 1.0 / 1024);
      ASSERT_LE(p.parameter, 1023.0 / 1024);
    }
  }
}

TEST_P(ContourLaws, IsovaluesAtTheEndsOfTheRangeAndBeyond) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Field steps = [](LatticePoint p) { return std::floor(3 * random_value(p, 2)); };
  for (const double isovalue : {0.0, -1.0, 2.5, -kInfinity, kInfinity, std::nan("")})
    EXPECT_EQ(extract_contour(h, steps, isovalue), Contour{}) << isovalue;
  EXPECT_EQ(extract_contour(
                h, [](LatticePoint) { return 7.0; }, 7),
            Contour{});
  // Differences of the greatest finite numbers overflow.
  const Field extremes = [](LatticePoint p) {
    return std::copysign(std::numeric_limits<double>::max(), random_value(p, 2) - 0.5);
  };
  const Contour contour = checked(extremes, 0);
  for (const EdgePoint& p : contour.edge_points) ASSERT_EQ(p.parameter, 0.5);
}

TEST_P(ContourLaws, HolesWhereValuesAreNotFinite) {
  const Field values = [](LatticePoint p) {
    const double hole = random_value(p, 77);
    return hole < 0.02   ? std::nan("")
           : hole < 0.04 ? std::numeric_limits<double>::infinity()
           : hole < 0.06 ? -std::numeric_limits<double>::infinity()
                         : random_value(p, 8);
  };
  const Contour contour = extract_contour(h, values, 0.5);
  test::expect_near(test::measure(contour), soup(h, values, 0.5), 1e-11);
  std::set<std::set<LatticePoint>> hole_faces;
  h.for_each_tetrahedron([&](const Diamond& d, int slot) {
    const auto vertices = d.tetrahedron(slot);
    if (std::all_of(vertices.begin(), vertices.end(), [&](auto p) { return std::isfinite(values(p)); }))
      return;
    for (const LatticePoint opposite : vertices) {
      std::set<LatticePoint> face(vertices.begin(), vertices.end());
      face.erase(opposite);
      hole_faces.insert(face);
    }
  });
  for (const auto& edge : test::border_edges(contour)) {
    std::set<LatticePoint> face;
    for (const std::uint32_t p : edge) {
      face.insert(contour.edge_points[p].first);
      face.insert(contour.edge_points[p].second);
    }
    ASSERT_EQ(face.size(), 3u);
    bool in_side = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const std::int32_t side : {0, domain.extent()[axis]})
        in_side |= std::all_of(face.begin(), face.end(), [&](LatticePoint p) { return p[axis] == side; });
    }
    ASSERT_TRUE(in_side || hole_faces.count(face) == 1);
  }
}

TEST_P(ContourLaws, HistoryDoesNotMatter) {
  IndexedHierarchy other(domain, 6);
  std::vector<LatticePoint> done = test::refine(other, 9);
  std::vector<LatticePoint> wanted;
  h.for_each_diamond([&](const Diamond& d, std::uint8_t) { wanted.push_back(d.point()); });
  for (const LatticePoint p : wanted) {
    for (const LatticePoint parent : Diamond(p).parents(domain)) other.split(parent, done);
  }
  for (std::size_t i = done.size(); i-- > 0;) {
    if (!h.is_split(done[i])) other.merge(done[i]);
  }
  ASSERT_EQ(other.checksum(), h.checksum());
  std::vector<LatticePoint> order;
  other.for_each_diamond([&](const Diamond& d, std::uint8_t) { order.push_back(d.point()); });
  if (order.size() > 100) {
    EXPECT_NE(order, wanted) << "nothing is tested where both tables have the same order";
  }
  const Field values = [](LatticePoint p) { return random_value(p, 4); };
  const Contour contour = extract_contour(h, values, 0.5);
  EXPECT_EQ(extract_contour(other, values, 0.5), contour);
  const LatticePoint last{domain.extent().i / 8 * 5, domain.extent().j / 4 * 3, domain.extent().k / 8 * 7};
  EXPECT_EQ(extract_contour(other, values, 0.5, {0, last}), extract_contour(h, values, 0.5, {0, last}));
}

INSTANTIATE_TEST_SUITE_P(Meshes, ContourLaws,
                         testing::Values(MeshCase{{1, 1, 1}, 0, 0}, MeshCase{{1, 1, 1}, 7, 0},
                                         MeshCase{{2, 1, 3}, 5, 0}, MeshCase{{1, 1, 1}, 2, 400},
                                         MeshCase{{2, 1, 3}, 0, 300}, MeshCase{{1, 2, 2}, 3, 600}));

TEST(Contour, SphereConvergesWithSecondOrder) {
  const Domain domain({{-1, -1, -1}, {1, 1, 1}}, {1, 1, 1});
  IndexedHierarchy h(domain, 6);
  const double pi = std::numbers::pi;
  const Field values = [&](LatticePoint p) {
    return 0.7 - norm(domain.position(p) - Vec3{0.03, 0.02, 0.01});
  };
  test::refine(h, 6);
  double last_area_error = 0, last_volume_error = 0;
  for (int level = 2; level <= 5; ++level, test::refine(h, 3)) {
    const test::SurfaceMeasure sphere = test::measure(extract_contour(h, values, 0));
    const double area_error = std::abs(sphere.area - 4 * pi * 0.49);
    const double volume_error = std::abs(sphere.volume - 4 * pi / 3 * 0.343);
    if (level > 2) {
      EXPECT_GT(last_area_error / area_error, 3.3);
      EXPECT_GT(last_volume_error / volume_error, 3.3);
    }
    last_area_error = area_error;
    last_volume_error = volume_error;
  }
  EXPECT_LT(last_area_error, 0.02);
  EXPECT_LT(last_volume_error, 0.01);
}

}  // namespace
}  // namespace adamas
