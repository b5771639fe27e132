// Tests blurred interfaces where something ends them: the domain's sides and sharp walls.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "core/base/parallel.h"
#include "interfaces/reconstruction/blurred_fractions.h"
#include "interfaces/reconstruction/normal_distribution.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "tests/support/closed_reconstruction.h"

namespace adamas {

using namespace interfaces;

namespace {

/// Returns a step across a plane that is oblique to two sides, blurred by 1.5 cells of size 1. Where it
/// `bends` it is as if a wall mirrored it at the side of least x: y is the convolution of |x| with the normal
/// distribution there.
MultiMaterialData slanted_step(bool bends) {
  constexpr std::size_t kSites = 20;
  constexpr double kBlur = 1.5, kSlope = 0.6;
  MultiMaterialData data;
  data.grid = RectilinearGrid::uniform({kSites, kSites, kSites}, {0, 0, 0}, {1, 1, 1});
  for (const char* name : {"above", "below"}) {
    data.materials.emplace_back(name);
    data.fractions.emplace_back(data.grid.site_count());
  }
  const double along = std::sqrt(1 + kSlope * kSlope), width = std::sqrt(kBlur * kBlur + 1.0 / 12);
  for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
    const Vec3 p = data.grid.site(site % kSites, site / kSites % kSites, site / (kSites * kSites));
    const double bent = p.x * std::erf(p.x / (std::numbers::sqrt2 * width)) +
                        2 * width * normal_density(p.x / width),
                 y = 5 + kSlope * (bends ? bent : p.x);
    const auto f = static_cast<float>(normal_probability((p.y - y) / along / width));
    data.fractions[MaterialId(0)][site] = f;
    data.fractions[MaterialId(1)][site] = 1 - f;
  }
  return data;
}

/// A step that continues beyond the grid does not bend at its sides.
TEST(BlurredFractions, StepsRunOnBeyondTheGrid) {
  const MultiMaterialData data = slanted_step(false);
  const GridSides sides = continued_sides(data, SiteValues(data));
  EXPECT_TRUE(sides[0] && sides[1]);
  const Reconstruction found(data);
  const Vec3 normal = normalized(Vec3{-0.6, 1, 0});
  double greatest = 0;
  for (const Vec3& p : found.mesh().points)
    greatest = std::max(greatest, std::abs(dot(normal, p - Vec3{0, 5, 0})));
  EXPECT_LT(greatest, 0.05);
  EXPECT_FALSE(continued_sides(slanted_step(true), SiteValues(slanted_step(true)))[0]);
}

/// A thin layer between two materials, blurred by more than its thickness and cut obliquely by the domain's
/// sides, is one closed body there too.
TEST(BlurredFractions, ALayerMeetsTheDomainsBorder) {
  constexpr std::size_t kSites = 20;
  constexpr double kThickness = 0.9, kWidth = 1.1;
  MultiMaterialData data;
  data.grid = RectilinearGrid::uniform({kSites, kSites, kSites}, {0, 0, 0}, {1, 1, 1});
  for (const char* name : {"above", "below", "layer"}) {
    data.materials.emplace_back(name);
    data.fractions.emplace_back(data.grid.site_count());
  }
  const Vec3 normal = normalized(Vec3{-0.5, 1, 0.2});
  for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
    const Vec3 p = data.grid.site(site % kSites, site / kSites % kSites, site / (kSites * kSites));
    const double y = dot(normal, p - Vec3{10, 10, 10});
    const std::array<double, 2> sides{normal_probability((y - kThickness / 2) / kWidth),
                                      normal_probability((-y - kThickness / 2) / kWidth)};
    data.fractions[MaterialId(0)][site] = static_cast<float>(sides[0]);
    data.fractions[MaterialId(1)][site] = static_cast<float>(sides[1]);
    data.fractions[MaterialId(2)][site] = static_cast<float>(1 - sides[0] - sides[1]);
  }
  data.normalise();
  const GridSides sides = continued_sides(data, SiteValues(data));
  EXPECT_TRUE(sides[0] && sides[1]);
  const Reconstruction found(data);
  test::expect_closed_with_totals(found, data);
  EXPECT_EQ(found.body_materials().size(), 3u);
  double farthest = 0;
  for (const Vec3& p : found.mesh().points) {
    const double height = std::abs(dot(normal, p - Vec3{10, 10, 10}));
    farthest = std::max(farthest, std::abs(height - kThickness / 2));
  }
  EXPECT_LT(farthest, 0.4);
}

/// Returns a sharp wall behind the plane through `wall` with this normal, and before it gas above air with a
/// step that is blurred by 1.5 cells. A cell's fractions are means over 5 x 5 x 5 points.
MultiMaterialData walled_gas(const Vec3& wall, const Vec3& normal, const Vec3& up) {
  constexpr std::size_t kSites = 24;
  constexpr int kPoints = 5;
  MultiMaterialData data;
  data.grid = RectilinearGrid::uniform({kSites, kSites, kSites}, {0, 0, 0}, {1, 1, 1});
  for (const char* name : {"air", "gas", "wall"}) {
    data.materials.emplace_back(name);
    data.fractions.emplace_back(data.grid.site_count());
  }
  for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
    const Vec3 centre = data.grid.site(site % kSites, site / kSites % kSites, site / (kSites * kSites));
    double gas = 0, solid = 0;
    for (int n = 0; n < kPoints * kPoints * kPoints; ++n) {
      const auto at = [&](int i) { return (i + 0.5) / kPoints - 0.5; };
      const Vec3 p = centre + Vec3{at(n % kPoints), at(n / kPoints % kPoints), at(n / (kPoints * kPoints))};
      const bool in_wall = dot(normal, p - wall) < 0;
      solid += in_wall ? 1 : 0;
      gas += in_wall ? 0 : normal_probability(dot(up, p - Vec3{12, 12, 12}) / 1.5);
    }
    solid /= kPoints * kPoints * kPoints, gas /= kPoints * kPoints * kPoints;
    data.fractions[MaterialId(1)][site] = static_cast<float>(gas);
    data.fractions[MaterialId(2)][site] = static_cast<float>(solid);
    data.fractions[MaterialId(0)][site] = static_cast<float>(std::max(0.0, 1 - gas - solid));
  }
  data.normalise();
  return data;
}

/// Returns the mean and the greatest distance from a plane of the points of some interfaces that are at least
/// a cell away from the domain's border.
std::array<double, 2> distance_from_plane(const Reconstruction& found, bool of_wall, const Vec3& on,
                                          const Vec3& normal) {
  std::set<std::uint32_t> points;
  for (const InterfaceTriangle& t : found.mesh().triangles) {
    if ((t.front == MaterialId(2) || t.back == MaterialId(2)) == of_wall)
      points.insert(t.points.begin(), t.points.end());
  }
  EXPECT_FALSE(points.empty());
  std::array<double, 2> result{0, 0};
  std::erase_if(points, [&](std::uint32_t p) {
    const Vec3& x = found.mesh().points[p];
    return std::min({x.x, x.y, x.z}) < 1 || std::max({x.x, x.y, x.z}) > 23;
  });
  for (const std::uint32_t p : points) {
    const double d = std::abs(dot(normal, found.mesh().points[p] - on));
    result[0] += d / static_cast<double>(points.size());
    result[1] = std::max(result[1], d);
  }
  return result;
}

/// A sharp wall stays sharp, and the blurred interface before it extends to it, both where the wall cuts
/// cells and where it lies between them.
TEST(BlurredFractions, WallsAreSharpBesideABlurredInterface) {
  const Vec3 up = normalized(Vec3{-0.2, 1, 0.3}), slanted = normalized(Vec3{1, 0.3, 0.2});
  for (const auto& [wall, normal] :
       {std::pair{Vec3{10.3, 12, 12}, slanted}, {Vec3{9, 0, 0}, Vec3{1, 0, 0}}}) {
    SCOPED_TRACE(wall.x);
    const MultiMaterialData data = walled_gas(wall, normal, up);
    set_thread_limit(1);
    const Reconstruction alone(data);
    set_thread_limit(0);
    const Reconstruction found(data);
    test::expect_closed(found, data.grid.domain());
    EXPECT_TRUE(found.mesh().points == alone.mesh().points);
    const auto of_wall = distance_from_plane(found, true, wall, normal),
               of_gas = distance_from_plane(found, false, {12, 12, 12}, up);
    EXPECT_LT(of_wall[0], 0.03);
    EXPECT_LT(of_wall[1], 0.5);
    EXPECT_LT(of_gas[0], 0.03);
    EXPECT_LT(of_gas[1], 0.3);
  }
}

}  // namespace
}  // namespace adamas
