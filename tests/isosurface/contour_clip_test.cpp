#include "isosurface/contour/contour_clip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/isosurface/contour_checks.h"

namespace adamas {

using namespace isosurface;
using test::IndexedHierarchy;

namespace {

using test::random_value;

constexpr int kLevels = 3;

/// A coarse mesh with values at its vertices, and the same piecewise linear function on the finest mesh. In
/// the finest mesh planes through lattice points cut no tetrahedron.
class ContourClip : public testing::TestWithParam<int> {
 protected:
  Domain domain = test::unit_domain({2, 1, 1});
  IndexedHierarchy coarse{domain, kLevels}, fine{domain, kLevels};
  std::map<LatticePoint, double> values;
  static constexpr std::int32_t kUnit = std::int32_t{1} << (kRootBits - kLevels);

  void SetUp() override {
    test::refine_randomly(coarse, 3, GetParam());
    coarse.for_each_tetrahedron([&](const Diamond& d, int slot) {
      for (const LatticePoint p : d.tetrahedron(slot)) values[p] = random_value(p, 6);
    });
    for (const LatticePoint p : test::refine(fine, 3 * kLevels)) {
      const auto [a, b] = Diamond(p).split_edge();
      values.try_emplace(p, 0.5 * (values.at(a) + values.at(b)));
    }
  }
  [[nodiscard]] double at(LatticePoint p) const { return values.at(p); }
  [[nodiscard]] Contour contour(const IndexedHierarchy& h, double isovalue, LatticePoint last,
                                double least_parameter = 0) const {
    return extract_contour(h, [this](LatticePoint p) { return at(p); }, isovalue, {least_parameter, last});
  }
};

TEST_P(ContourClip, IsThePartOfTheContourInTheBox) {
  std::size_t largest = 0;
  for (const LatticePoint units : {LatticePoint{11, 8, 8}, {16, 5, 8}, {16, 8, 3}, {11, 7, 5}, {9, 3, 1}}) {
    const LatticePoint last = kUnit * units;
    const Contour clipped = contour(coarse, 0.5, last), exact = contour(fine, 0.5, last);
    EXPECT_TRUE(exact.mean_points.empty());
    const Box3 box{{0, 0, 0}, domain.position(last)};
    test::expect_closed(clipped, box);
    test::expect_closed(exact, box);
    EXPECT_EQ(clipped.triangles.empty(), exact.triangles.empty());
    largest = std::max(largest, clipped.triangles.size());
    test::expect_near(test::measure(clipped), test::measure(exact), 1e-12);
    test::expect_closed(contour(coarse, 0.5, last, 1.0 / 1024), box);
  }
  EXPECT_GT(largest, 5u);
}

TEST_P(ContourClip, MeanPointsAreMeansOfVertices) {
  const LatticePoint last = kUnit * LatticePoint{11, 7, 5};
  const Contour clipped = contour(coarse, 0.5, last);
  if (GetParam() < 100) {
    EXPECT_FALSE(clipped.mean_points.empty());
  }
  std::vector<bool> used(clipped.points.size());
  for (const auto& triangle : clipped.triangles) {
    for (const std::uint32_t p : triangle) used[p] = true;
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
  for (std::size_t i = 0; i < clipped.mean_points.size(); ++i) {
    const MeanPoint& p = clipped.mean_points[i];
    Vec3 position;
    double weight = 0, value = 0;
    for (std::size_t v = 0; v < 4; ++v) {
      if (p.weights[v] == 0) continue;
      weight += p.weights[v];
      value += p.weights[v] * at(p.vertices[v]);
      position += p.weights[v] * domain.position(p.vertices[v]);
    }
    EXPECT_NEAR(weight, 1, 1e-13);
    EXPECT_NEAR(value, 0.5, 1e-13);
    EXPECT_LT(distance(position, clipped.points[clipped.edge_points.size() + i]), 1e-13);
  }
}

TEST_P(ContourClip, SamplesEqualToTheIsovalue) {
  for (auto& [p, value] : values) value = std::floor(3 * random_value(p, 1));
  for (const LatticePoint units : {LatticePoint{8, 4, 4}, {11, 7, 5}, {12, 8, 2}}) {
    const LatticePoint last = kUnit * units;
    for (const double least : {0.0, 1.0 / 1024}) {
      for (const double isovalue : {1.0, 2.0}) {
        test::expect_closed(contour(coarse, isovalue, last, least), {{0, 0, 0}, domain.position(last)});
      }
    }
  }
}

TEST_P(ContourClip, TheDomainItselfCutsNothing) {
  const Contour whole = extract_contour(
      coarse, [this](LatticePoint p) { return at(p); }, 0.5);
  EXPECT_EQ(contour(coarse, 0.5, domain.extent()), whole);
  EXPECT_TRUE(whole.mean_points.empty());
}

/// Diamonds wholly outside the data are not asked for their values. Those on the data's border reach half a
/// root beyond it.
TEST_P(ContourClip, AsksForNoValuesFarBeyond) {
  const LatticePoint last = kUnit * LatticePoint{8, 8, 8};
  const auto guarded = [&](LatticePoint p) {
    EXPECT_LE(p.i, 12 * kUnit);
    return at(p);
  };
  const Contour half = extract_contour(coarse, guarded, 0.5, {0, last});
  EXPECT_TRUE(half.mean_points.empty()) << "the second root begins at the plane";
  test::expect_closed(half, {{0, 0, 0}, domain.position(last)});
}

TEST_P(ContourClip, PlanesCutAsSidesOfABoxDo) {
  const LatticePoint all = kUnit * LatticePoint{16, 8, 8};
  const Contour whole = contour(coarse, 0.5, all);
  const Box3 box{{0.21, 0.11, 0.32}, {1.7, 0.83, 0.91}};
  Contour by_box = whole, by_planes = whole;
  clip_contour(by_box, box);
  std::vector<Plane> sides;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 normal;
    normal[axis] = 3;
    sides.push_back({box.max, normal});
    sides.push_back({box.min, -normal});
  }
  clip_contour(by_planes, sides);
  ASSERT_EQ(by_planes.triangles, by_box.triangles);
  for (std::size_t p = 0; p < by_box.points.size(); ++p)
    EXPECT_LT(distance(by_planes.points[p], by_box.points[p]), 1e-12);
  // The parts on both sides of an oblique plane add up to the whole.
  const Plane aslant{{1, 0.5, 0.5}, {1, -2, 0.7}};
  Contour below = whole, above = whole;
  clip_contour(below, std::vector<Plane>{aslant});
  clip_contour(above, std::vector<Plane>{{aslant.origin, -aslant.normal}});
  const auto area = [](const Contour& c) {
    double sum = 0;
    for (const auto& [i, j, k] : c.triangles)
      sum += 0.5 * norm(cross(c.points[j] - c.points[i], c.points[k] - c.points[i]));
    return sum;
  };
  EXPECT_NEAR(area(below) + area(above), area(whole), 1e-9 * (1 + area(whole)));
  for (const Vec3& p : below.points) EXPECT_LE(dot(aslant.normal, p - aslant.origin), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Splits, ContourClip, testing::Values(0, 3, 20, 60));

TEST(ContourClipping, TrianglesOnThePlaneStay) {
  Contour square;
  square.points = {{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}, {2, 0, 0}, {0, 0, 0}};
  square.edge_points.resize(6);
  square.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 1, 4}, {5, 4, 1}};
  clip_contour(square, {{-5, -5, -5}, {1, 5, 5}});
  // The triangle beyond the box goes. The last one keeps its half up to the corner that lies on the plane.
  const std::vector<std::array<std::uint32_t, 3>> wanted{{0, 1, 2}, {0, 2, 3}, {4, 5, 1}};
  EXPECT_EQ(square.triangles, wanted);
  EXPECT_EQ(square.points[5], (Vec3{1, 0, 0}));
  EXPECT_EQ(square.mean_points.size(), 1u);
}

}  // namespace
}  // namespace adamas
