#include "core/picture/raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

#include "core/base/error.h"
#include "core/picture/scan_convex.h"

namespace adamas {

using namespace picture;

namespace {

constexpr int kSize = 64;

std::vector<Vec2> random_convex_polygon(std::mt19937_64& random, int corners) {
  std::uniform_real_distribution<double> unit(0, 1);
  const Vec2 centre{kSize * (1.4 * unit(random) - 0.2), kSize * (1.4 * unit(random) - 0.2)};
  const double a = 40 * unit(random), b = 40 * unit(random), tilt = 7 * unit(random);
  std::vector<double> angles(static_cast<std::size_t>(corners));
  for (double& angle : angles) angle = 2 * std::numbers::pi * unit(random);
  std::sort(angles.begin(), angles.end());
  if (unit(random) < 0.5) std::reverse(angles.begin(), angles.end());
  std::vector<Vec2> points;
  for (const double angle : angles) {
    const double x = a * std::cos(angle), y = b * std::sin(angle);
    points.push_back(centre +
                     Vec2{x * std::cos(tilt) - y * std::sin(tilt), x * std::sin(tilt) + y * std::cos(tilt)});
  }
  return points;
}

// Returns whether a point is inside a polygon, by the number of crossings of a ray to the right.
bool inside(const std::vector<Vec2>& polygon, const Vec2& p) {
  bool odd = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if (p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)) odd = !odd;
  }
  return odd;
}

TEST(Raster, PolygonsCoverThePixelsWhoseCentresTheyHold) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 500; ++round) {
    const std::vector<Vec2> polygon = random_convex_polygon(random, 3 + round % 6);
    std::vector<int> count(kSize * kSize, 0);
    scan_convex_polygon(polygon, kSize, kSize,
                        [&](int x, int y) { ++count[static_cast<std::size_t>(y * kSize + x)]; });
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        ASSERT_EQ(count[static_cast<std::size_t>(y * kSize + x)], inside(polygon, {x + 0.5, y + 0.5}) ? 1 : 0)
            << x << " " << y;
      }
    }
  }
}

using Triangle = std::array<Vec2, 3>;

std::vector<Triangle> triangulated_square(std::mt19937_64& random, int points) {
  // Points are inserted one by one, each into a triangle that contains it.
  const Vec2 a{0, 0}, b{kSize, 0}, c{kSize, kSize}, d{0, kSize};
  std::vector<Triangle> triangles{{a, b, c}, {a, c, d}};
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < points; ++i) {
    const std::size_t k = random() % triangles.size();
    const Triangle t = triangles[k];
    double u = unit(random), v = unit(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    Vec2 p = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
    // Some points lie on centres or corners of pixels, where ties occur.
    if (i % 3 == 0) p = {std::round(2 * p.x) / 2, std::round(2 * p.y) / 2};
    const auto area = [](const Vec2& x, const Vec2& y, const Vec2& z) { return cross(y - x, z - x); };
    if (area(t[0], t[1], p) <= 0 || area(t[1], t[2], p) <= 0 || area(t[2], t[0], p) <= 0) continue;
    triangles[k] = {t[0], t[1], p};
    triangles.push_back({t[1], t[2], p});
    triangles.push_back({t[2], t[0], p});
  }
  return triangles;
}

TEST(Raster, TriangulationsOfASquareCoverEveryPixelOnce) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 100; ++round) {
    std::vector<int> count(kSize * kSize, 0);
    const std::vector<Triangle> triangles = triangulated_square(random, 20 * round);
    for (const Triangle& t : triangles) {
      scan_convex_polygon(t, kSize, kSize,
                          [&](int x, int y) { ++count[static_cast<std::size_t>(y * kSize + x)]; });
    }
    for (const int n : count) ASSERT_EQ(n, 1) << triangles.size();
  }
}

TEST(Raster, NothingIsLeftOutBesideEdgesWithMorePointsOnOneSide) {
  std::mt19937_64 random(4);
  const auto place = [&random] {
    return Vec2{static_cast<double>(random() % kSize) + 0.5, static_cast<double>(random() % kSize) + 0.5};
  };
  std::uniform_real_distribution<double> unit(0, 1);
  int left_out = 0;
  for (int round = 0; round < 1000; ++round) {
    // The ends of the edge are centres of pixels, so that further centres may lie on it.
    const Vec2 a = place(), b = place();
    if (norm(b - a) < 4) continue;
    const Vec2 aside = Vec2{a.y - b.y, b.x - a.x};
    std::vector<double> parts{unit(random), unit(random), unit(random)};
    std::sort(parts.begin(), parts.end());
    std::vector<Vec2> whole{a, b, 0.5 * (a + b) + 100 * aside}, divided{a};
    for (const double part : parts) divided.push_back(a + part * (b - a));
    divided.push_back(b);
    divided.push_back(0.5 * (a + b) - 100 * aside);
    Raster filled(kSize, kSize), exact(kSize, kSize);
    for (const auto& polygon : {whole, divided}) {
      fill_polygon(filled, polygon, {0, 0, 0});
      scan_convex_polygon(polygon, kSize, kSize, [&exact](int x, int y) { exact.set(x, y, {0, 0, 0}); });
    }
    const auto steps = std::gcd(std::abs(std::lround(b.x - a.x)), std::abs(std::lround(b.y - a.y)));
    for (long n = 1; n < steps; ++n) {
      const double part = static_cast<double>(n) / static_cast<double>(steps);
      const int x = static_cast<int>(a.x + part * (b.x - a.x)),
                y = static_cast<int>(a.y + part * (b.y - a.y));
      ASSERT_EQ(filled.at(x, y).a, 255) << round << ": " << x << ", " << y;
      left_out += exact.at(x, y).a == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(left_out, 0) << "there is nothing to mend";
}

TEST(Raster, FieldsAreEvaluatedAtPixelCentres) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  const ColourMap map = ColourMap::sequential();
  for (int round = 0; round < 100; ++round) {
    const double gx = unit(random) / kSize, gy = unit(random) / kSize, g0 = unit(random);
    const auto field = [&](const Vec2& p) { return g0 + gx * p.x + gy * p.y; };
    const std::vector<Vec2> polygon = random_convex_polygon(random, 3 + round % 5);
    std::vector<double> values;
    for (const Vec2& p : polygon) values.push_back(field(p));
    Raster raster(kSize, kSize);
    fill_field_polygon(raster, polygon, values, -2, 2, map);
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const Vec2 centre{x + 0.5, y + 0.5};
        if (!inside(polygon, centre)) {
          ASSERT_EQ(raster.at(x, y).a, 0);
          continue;
        }
        const auto expected = to_bytes(map.at((field(centre) + 2) / 4));
        const Raster::Pixel& found = raster.at(x, y);
        ASSERT_NEAR(found.r, expected[0], 1);
        ASSERT_NEAR(found.g, expected[1], 1);
        ASSERT_NEAR(found.b, expected[2], 1);
        ASSERT_EQ(found.a, 255);
      }
    }
  }
}

TEST(Raster, FieldStaysWithinTheCornersEvenOnSlivers) {
  const std::vector<Vec2> sliver{{0, 10}, {60, 10.6}, {30, 10.3 + 1e-13}};
  const LinearField field = LinearField::fit(sliver, std::vector<double>{1, 2, 40});
  for (double x = -10; x < 70; x += 0.7) {
    EXPECT_GE(field.at({x, 11}), 1);
    EXPECT_LE(field.at({x, 11}), 40);
  }
}

TEST(Raster, MissingValuesAndEqualRange) {
  const std::vector<Vec2> square{{0, 0}, {8, 0}, {8, 8}, {0, 8}};
  Raster raster(8, 8);
  fill_field_polygon(raster, square, std::vector<double>{1, 2, NAN, 4}, 0, 4, ColourMap::sequential());
  const auto missing = to_bytes(ColourMap::no_data());
  EXPECT_EQ(raster.at(3, 3), (Raster::Pixel{missing[0], missing[1], missing[2], 255}));
  fill_field_polygon(raster, square, std::vector<double>{5, 5, 5, 5}, 5, 5, ColourMap::sequential());
  const auto middle = to_bytes(ColourMap::sequential().at(0.5));
  EXPECT_EQ(raster.at(3, 3), (Raster::Pixel{middle[0], middle[1], middle[2], 255}));
}

TEST(Raster, ReductionAveragesByOpacity) {
  Raster raster(4, 2);
  raster.at(0, 0) = {200, 0, 0, 255};
  raster.at(1, 0) = {100, 0, 0, 255};
  for (int y = 0; y < 2; ++y) raster.at(2, y) = raster.at(3, y) = {10, 20, 30, 255};
  const Raster half = raster.reduced(2);
  ASSERT_EQ(half.width(), 2);
  ASSERT_EQ(half.height(), 1);
  EXPECT_EQ(half.at(0, 0), (Raster::Pixel{150, 0, 0, 128}));
  EXPECT_EQ(half.at(1, 0), (Raster::Pixel{10, 20, 30, 255}));
  EXPECT_THROW(Raster(0, 5), Error);
  EXPECT_THROW(Raster(5, 40000), Error);
}

}  // namespace
}  // namespace adamas
