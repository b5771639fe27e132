#include "isosurface/contour/join_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "isosurface/contour/decimate.h"
#include "tests/isosurface/contour_checks.h"

namespace adamas {

using namespace isosurface;
using test::IndexedHierarchy;

namespace {

using test::random_value;
using Field = std::function<double(LatticePoint)>;

constexpr double kLeastParameter = 1.0 / 1024;

double in_units(std::int32_t x) { return std::ldexp(x, -kRootBits); }

/// Returns a value that is positive inside a ball about the middle of the domain.
double ball(LatticePoint p) {
  const Vec3 way{in_units(p.i) - 0.5, in_units(p.j) - 0.5, in_units(p.k) - 0.5};
  return 0.35 - norm(way);
}

constexpr Vec3 kMiddle{0.5, 0.5, 0.5};

/// Expects the area of the ball, and that no triangle is turned over.
void expect_outwards(const Contour& contour) {
  double area = 0;
  for (const auto& [a, b, c] : contour.triangles) {
    const Vec3 &p = contour.points[a], &q = contour.points[b], &r = contour.points[c];
    const Vec3 normal = cross(q - p, r - p);
    area += 0.5 * norm(normal);
    EXPECT_GT(dot(normal, p - kMiddle), 0);
  }
  EXPECT_NEAR(area, 4 * std::numbers::pi * 0.35 * 0.35, 0.06);
}

/// Returns rough values with bumps of several sizes.
Field rough(unsigned seed) {
  return [seed](LatticePoint p) { return ball(p) + 0.5 * (random_value(p, seed) - 0.5); };
}

class JoinedContours : public testing::TestWithParam<int> {
 protected:
  Domain domain = test::unit_domain({1, 1, 1});
  IndexedHierarchy h{domain, 6};

  void SetUp() override {
    test::refine(h, 12);
    test::refine_randomly(h, 7, GetParam());
  }
  [[nodiscard]] Contour contour(const Field& values, double isovalue, bool join) const {
    return extract_contour(h, values, isovalue, {kLeastParameter, {}, {}, join});
  }
};

TEST_P(JoinedContours, KeepTheTopologyOfNoise) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Field everywhere = [seed](LatticePoint p) { return random_value(p, seed); };
    for (const Field& values : {everywhere, rough(seed)}) {
      for (const double isovalue : {0.0, 0.2, 0.5, 0.8}) {
        const Contour plain = contour(values, isovalue, false), joined = contour(values, isovalue, true);
        test::expect_closed(joined, domain.box());
        EXPECT_EQ(test::topology(joined), test::topology(plain));
        EXPECT_EQ(joined, contour(values, isovalue, true));
        EXPECT_LE(joined.triangles.size(), plain.triangles.size());
      }
    }
  }
}

TEST_P(JoinedContours, ArePiecesOfTheirOwnWhereNothingElseIsLeft) {
  // One vertex, or two neighbours, are above the isovalue: these are the smallest balls.
  const LatticePoint middle{1 << (kRootBits - 1), 1 << (kRootBits - 1), 1 << (kRootBits - 1)};
  for (const double second : {-1.0, 0.4}) {
    const Field values = [&](LatticePoint p) {
      if (p == middle) return 0.6;
      return p.j == middle.j && p.k == middle.k && std::abs(p.i - middle.i) <= 1 << (kRootBits - 4) ? second
                                                                                                    : -1.0;
    };
    const Contour joined = contour(values, 0, true);
    EXPECT_EQ(test::topology(joined), std::vector<int>{2});
  }
}

TEST_P(JoinedContours, HaveAThirdOfTheTrianglesAndWiderOnes) {
  const Contour plain = contour(ball, 0, false), joined = contour(ball, 0, true);
  EXPECT_LT(static_cast<double>(joined.triangles.size()), 0.4 * static_cast<double>(plain.triangles.size()));
  const auto narrow = [](const Contour& c) {
    std::size_t count = 0;
    for (const auto& t : c.triangles) {
      const Vec3 u = c.points[t[1]] - c.points[t[0]], v = c.points[t[2]] - c.points[t[0]];
      const double longest = std::max({squared_norm(u), squared_norm(v), squared_norm(u - v)});
      count += norm(cross(u, v)) < 0.3 * longest ? 1 : 0;  // the norm is twice the area
    }
    return static_cast<double>(count) / static_cast<double>(c.triangles.size());
  };
  EXPECT_LT(narrow(joined), 0.3 * narrow(plain));
  // Vertices are means of points round one vertex of the mesh, so their distance from the ball is only a part
  // of a cell's height.
  for (const Vec3& p : joined.points) EXPECT_NEAR(norm(p - kMiddle), 0.35, 0.02);
  expect_outwards(joined);
}

TEST_P(JoinedContours, EndWhereValuesAreNone) {
  const Field values = [](LatticePoint p) {
    return random_value(p, 3) < 0.05 ? std::numeric_limits<double>::quiet_NaN() : rough(1)(p);
  };
  const Contour plain = contour(values, 0, false), joined = contour(values, 0, true);
  ASSERT_FALSE(test::border_edges(plain).empty());
  EXPECT_EQ(test::border_edges(joined).size(), test::border_edges(plain).size());
}

TEST_P(JoinedContours, AreTakenApartToNoMoreTrianglesThanWanted) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    for (const Field& values : {rough(seed), Field(ball)}) {
      // At 0.05 the ball lies inside the domain; at -0.2 the domain's sides cut it.
      for (const double isovalue : {0.05, -0.2}) {
        const Contour joined = contour(values, isovalue, true);
        const std::vector<int> before = test::topology(joined);
        for (const std::size_t part : {2u, 5u, 20u}) {
          const std::size_t wanted = joined.triangles.size() / part;
          Contour few = joined;
          const Decimation done = decimate_contour(few, wanted);
          EXPECT_TRUE(std::isfinite(done.error));
          test::expect_closed(few, domain.box());
          // Only whole bodies may be lost; the topology of all others is unchanged.
          const std::vector<int> after = test::topology(few);
          EXPECT_TRUE(std::includes(before.begin(), before.end(), after.begin(), after.end()));
          EXPECT_EQ(after.size() + done.bodies, before.size());
          // A smooth surface can be decimated as far as is wanted; bodies of a rough one keep at least four
          // triangles.
          if (isovalue > 0 && part < 20) {
            EXPECT_LE(few.triangles.size(), std::max<std::size_t>(wanted, 8 * before.size()));
          }
          Contour again = joined;
          decimate_contour(again, wanted);
          EXPECT_EQ(few, again);
        }
      }
    }
  }
}

TEST_P(JoinedContours, StayNearTheBallWithFewTriangles) {
  Contour few = contour(ball, 0, true);
  const std::size_t wanted = few.triangles.size() / 4;
  decimate_contour(few, wanted);
  EXPECT_LE(few.triangles.size(), wanted);
  EXPECT_GE(few.triangles.size() + 2, wanted);
  expect_outwards(few);
}

INSTANTIATE_TEST_SUITE_P(Meshes, JoinedContours, testing::Values(0, 300));

}  // namespace
}  // namespace adamas
