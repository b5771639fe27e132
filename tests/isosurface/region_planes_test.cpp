// Tests regions whose planes pass through samples, as exactly as rounding allows, and regions with any
// planes: the surface that is left has no triangles without area and no points that occur twice. Also tests
// the smallest volume that has a surface.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <set>
#include <string>

#include "tests/isosurface/contour_checks.h"
#include "tests/isosurface/surface_checks.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::MemoryVolume;
using test::OpenStore;

using Floats = std::array<float, 3>;

Floats in_file(const Vec3& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// Expects neither triangles without area nor equal points, both in double precision and in the single
/// precision of files.
void expect_no_flat_triangles(const Contour& contour, const std::string& what) {
  std::set<Floats> places;
  for (const Vec3& p : contour.points) places.insert(in_file(p));
  EXPECT_EQ(places.size(), contour.points.size()) << what << ": points that are there twice";
  std::size_t flat = 0, flat_in_file = 0;
  for (const auto& [a, b, c] : contour.triangles) {
    const auto area = [](const Vec3& p, const Vec3& q, const Vec3& r) { return norm(cross(q - p, r - p)); };
    const auto rounded = [&](std::uint32_t n) {
      const Floats p = in_file(contour.points[n]);
      return Vec3{p[0], p[1], p[2]};
    };
    flat += area(contour.points[a], contour.points[b], contour.points[c]) > 0 ? 0 : 1;
    flat_in_file += area(rounded(a), rounded(b), rounded(c)) > 0 ? 0 : 1;
  }
  EXPECT_EQ(flat, 0u) << what;
  EXPECT_EQ(flat_in_file, 0u) << what;
}

struct Place {
  Vec3 spacing, origin;
};
/// Spacings and origins that are no exact doubles, and origins far away compared with the size of the data.
const std::vector<Place> kPlaces{{{1, 1, 1}, {0, 0, 0}},
                                 {{0.1, 0.1, 0.1}, {0, 0, 0}},
                                 {{0.1, 0.3, 0.7}, {0.05, -3, 100}},
                                 {{1e-3, 2e-3, 1e-3}, {0.7, 0.7, -0.3}}};

class RegionPlanes : public testing::Test {
 protected:
  /// Returns hills whose samples are whole numbers, so that many samples equal the isovalue.
  [[nodiscard]] static MemoryVolume<std::uint8_t> hills(const Place& place) {
    return MemoryVolume<std::uint8_t>(
        {33, 30, 27},
        [](LatticePoint p) {
          return std::floor(100 + 60 * std::sin(0.5 * p.i + 0.2 * p.k) * std::cos(0.4 * p.j));
        },
        place.spacing, place.origin);
  }
};

TEST_F(RegionPlanes, AreThoseOfSamples) {
  std::mt19937 random(7);
  for (const Place& place : kPlaces) {
    const auto volume = hills(place);
    OpenStore<std::uint8_t> store(volume);
    for (const double isovalue : {100.0, 120.5}) {
      for (int n = 0; n < 12; ++n) {
        SurfaceRequest request;
        request.isovalue = isovalue;
        request.error = n % 3 == 0 ? 0.4 * place.spacing.x : 0;
        Box3 region;
        for (int axis = 0; axis < 3; ++axis) {
          // Half of the places are what a user would compute, the others are off by one unit in the last
          // place.
          const auto at = [&](std::uint32_t sample) {
            const double x = place.origin[axis] + sample * place.spacing[axis];
            return n % 2 == 0 ? x : std::nextafter(x, random() % 2 == 0 ? -1e9 : 1e9);
          };
          region.min[axis] = at(2 + random() % 8);
          region.max[axis] = at(14 + random() % 8);
        }
        request.region = region;
        const Contour contour = store.extract(request).contour;
        ASSERT_GT(contour.triangles.size(), 50u);
        test::expect_sound(contour, region);
        expect_no_flat_triangles(contour, "region " + std::to_string(n));
        if (HasFailure()) return;
      }
    }
  }
}

TEST_F(RegionPlanes, MayBeAnywhere) {
  std::mt19937 random(8);
  for (const Place& place : kPlaces) {
    const auto volume = hills(place);
    OpenStore<std::uint8_t> store(volume);
    for (int n = 0; n < 12; ++n) {
      SurfaceRequest request;
      request.isovalue = n % 2 == 0 ? 100 : 90.25;
      Box3 region;
      for (int axis = 0; axis < 3; ++axis) {
        const auto at = [&](double samples) {
          return place.origin[axis] + (samples + 8.0 * random() / 0xffffffffu) * place.spacing[axis];
        };
        region.min[axis] = at(2);
        region.max[axis] = at(14);
      }
      request.region = region;
      const Contour contour = store.extract(request).contour;
      test::expect_sound(contour, region);
      expect_no_flat_triangles(contour, "region " + std::to_string(n));
      if (HasFailure()) return;
    }
  }
}

/// The surface in a region is part of the whole surface, whether the region's planes pass through samples or
/// beside them.
TEST_F(RegionPlanes, LeaveTheSurfaceWhereItIs) {
  const Place place{{0.1, 0.3, 0.7}, {0.05, -3, 100}};
  const auto volume = hills(place);
  OpenStore<std::uint8_t> store(volume);
  SurfaceRequest request;
  request.isovalue = 100;
  const auto of_region = [&](double shift) {
    Box3 region;
    for (int axis = 0; axis < 3; ++axis) {
      region.min[axis] = place.origin[axis] + (3 + shift) * place.spacing[axis];
      region.max[axis] = place.origin[axis] + (20 + shift) * place.spacing[axis];
    }
    request.region = region;
    return test::measure(store.extract(request).contour);
  };
  const test::SurfaceMeasure exact = of_region(0);
  test::expect_near(of_region(1e-5), exact, 1e-3 * exact.area);
  test::expect_near(of_region(-1e-5), exact, 1e-3 * exact.area);
}

/// With two samples along each axis the samples are the corners of the domain.
TEST(SurfaceOfEightSamples, HasARange) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::array<double, 2> range{1e9, -1e9};
    const MemoryVolume<float> volume({2, 2, 2}, [&](LatticePoint) {
      const double x = random() % 1000;
      range = {std::min(range[0], x), std::max(range[1], x)};
      return x;
    });
    OpenStore<float> store(volume);
    EXPECT_EQ(store.extractor().range(), range);
    const Contour contour = store.extract(0.5 * (range[0] + range[1])).contour;
    EXPECT_FALSE(contour.triangles.empty());
    test::expect_sound(contour, volume.grid.box());
  }
}

}  // namespace
}  // namespace adamas
