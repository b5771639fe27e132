#include "isosurface/extraction/surface_extractor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "tests/isosurface/contour_checks.h"
#include "tests/isosurface/surface_checks.h"

namespace adamas {

using namespace isosurface;
using test::IndexedHierarchy;

namespace {

using test::Dimensions;
using test::MemoryVolume;
using test::OpenStore;

/// Returns hills with a little noise.
template <class Sample>
MemoryVolume<Sample> hills(const Dimensions& dimensions, double noise = 3, const Vec3& spacing = {1, 1, 1}) {
  return {dimensions,
          [&, random = std::mt19937(6)](LatticePoint p) mutable {
            return 100 + 60 * std::sin(0.35 * p.i + 0.2 * p.k) * std::cos(0.3 * p.j) +
                   noise * static_cast<double>(random() % 1024) / 1024;
          },
          spacing,
          {5, -3, 2}};
}

template <class Sample>
MemoryVolume<Sample> noise(const Dimensions& dimensions) {
  return {dimensions, [random = std::mt19937(6)](LatticePoint) mutable { return random() % 251; }};
}

template <class Sample>
class SurfaceOf : public testing::Test {
 protected:
  /// Expects that the surface is the contour of the mesh in which those stored diamonds are split that it
  /// crosses with too great an error.
  static void expect_the_mesh(const MemoryVolume<Sample>& volume, const std::vector<double>& isovalues,
                              const std::vector<double>& errors) {
    OpenStore<Sample> store(volume);
    const test::DiamondTable<Sample> table(store);
    const int depth = store.pages().grid().depth();
    std::size_t coarse = 0, fine = 0;
    for (const double isovalue : isovalues) {
      for (const double error : errors) {
        SCOPED_TRACE(testing::Message() << "isovalue " << isovalue << ", error " << error);
        const ExtractedSurface surface = store.extract(isovalue, error);
        const IndexedHierarchy mesh = table.mesh(isovalue, error);
        const auto options = test::options_of(volume, depth, 1.0 / 1024);
        const auto field = test::field_of(volume, depth);
        const Contour wanted = extract_contour(mesh, field, isovalue, options);
        expect_equal(surface.contour, wanted);
        test::expect_sound(surface.contour, volume.grid.box());
        EXPECT_LE(surface.max_error, error);
        coarse = std::max(coarse, mesh.tetrahedron_count());
        fine = std::max(fine, surface.contour.triangles.size());
      }
    }
    EXPECT_GT(coarse, 100u);
    EXPECT_GT(fine, 100u);
  }

  static void expect_equal(const Contour& found, const Contour& wanted) {
    ASSERT_EQ(found.points.size(), wanted.points.size());
    ASSERT_EQ(found.triangles.size(), wanted.triangles.size());
    if (wanted.mean_points.empty()) {
      ASSERT_EQ(test::triangle_set(found), test::triangle_set(wanted));
    }
    const auto corners = [](const Contour& contour) {
      std::multiset<std::array<double, 9>> all;
      for (const auto& t : contour.triangles) {
        std::array<std::array<double, 3>, 3> places{};
        for (std::size_t c = 0; c < 3; ++c) {
          const Vec3& p = contour.points[t[c]];
          places[c] = {p.x, p.y, p.z};
        }
        std::rotate(places.begin(), std::min_element(places.begin(), places.end()), places.end());
        std::array<double, 9> flat{};
        for (std::size_t n = 0; n < 9; ++n) flat[n] = places[n / 3][n % 3];
        all.insert(flat);
      }
      return all;
    };
    // Where several triangles are cut at the border, any of their points may be the first.
    if (wanted.mean_points.empty()) {
      ASSERT_EQ(corners(found), corners(wanted));
    }
    test::expect_near(test::measure(found), test::measure(wanted), 1e-7 * (1 + test::measure(wanted).area));
  }
};
using Samples = testing::Types<std::uint8_t, std::uint16_t, std::int16_t, float>;
TYPED_TEST_SUITE(SurfaceOf, Samples);

TYPED_TEST(SurfaceOf, IsThatOfTheMeshWithTheSameSplits) {
  this->expect_the_mesh(hills<TypeParam>({17, 17, 33}), {70, 128}, {0, 0.2, 6, 100});
  this->expect_the_mesh(hills<TypeParam>({35, 19, 22}, 3, {1, 2, 0.5}), {100}, {0.3, 2});
  this->expect_the_mesh(noise<TypeParam>({18, 17, 9}), {1, 128, 250}, {0, 0.5, 3});
}

/// Where the data are not exactly linear in any tetrahedron, error 0 leads to the finest mesh.
TEST(SurfaceExtractor, WithoutErrorIsTheContourOfTheFullMesh) {
  for (const Dimensions& box : std::vector<Dimensions>{{9, 9, 9}, {17, 17, 17}}) {
    const MemoryVolume<float> volume(box, [random = std::mt19937(9)](LatticePoint) mutable {
      return static_cast<double>(random()) * 0x1p-32;
    });
    for (const double isovalue : {0.1, 0.5, 0.9}) {
      OpenStore<float> store(volume);
      const int lods = store.pages().grid().depth();
      const Contour found = store.extract(isovalue).contour;
      const Contour wanted =
          extract_contour(test::DiamondTable(store).full_mesh(), test::field_of(volume, lods), isovalue,
                          test::options_of(volume, lods, 1.0 / 1024));
      ASSERT_EQ(test::triangle_set(found), test::triangle_set(wanted));
      test::expect_sound(found, volume.grid.box());
    }
  }
}

/// As a set of points the surface is that of the full mesh, also where parts of the data are linear, so that
/// fewer triangles are enough.
TEST(SurfaceExtractor, WithoutErrorHasThePointsOfTheFullMesh) {
  for (const Vec3& spacing : std::vector<Vec3>{{1, 1, 1}, {0.5, 2, 1}}) {
    const MemoryVolume<std::uint8_t> volume(
        {19, 13, 16},
        [](LatticePoint p) { return p.i + p.j < 20 ? 3 * p.i + 2 * p.k : 60 + (p.i * p.j + p.k) % 17; },
        spacing);
    OpenStore<std::uint8_t> store(volume);
    const int lods = store.pages().grid().depth();
    const IndexedHierarchy full = test::DiamondTable(store).full_mesh();
    const auto field = test::field_of(volume, lods);
    for (const double isovalue : {30.5, 66.25}) {
      SurfaceRequest request;
      request.isovalue = isovalue;
      request.least_parameter = 0;
      const ExtractedSurface surface = store.extract(request);
      const Contour wanted = extract_contour(full, field, isovalue, test::options_of(volume, lods, 0));
      test::expect_near(test::measure(surface.contour), test::measure(wanted),
                        1e-8 * (1 + test::measure(wanted).area));
      EXPECT_LT(surface.contour.triangles.size(), wanted.triangles.size());
      const test::MeshFunction function(full, field);
      for (const Vec3& p : test::points_on(surface.contour))
        ASSERT_NEAR(function.at(p).value, isovalue, 1e-9);
      EXPECT_EQ(surface.max_error, 0);
    }
  }
}

/// A few samples of linear data are missing. Tetrahedra that contain one, inside or on their boundary, are
/// split until it is a corner, so they have no surface; the others are not split at all.
TEST(SurfaceExtractor, WithoutErrorHasTheHolesOfTheFullMesh) {
  constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
  const std::set<LatticePoint> missing{{5, 9, 7}, {8, 8, 8},    {13, 6, 11},
                                       {3, 3, 2}, {20, 12, 10}, {16, 9, 0}};
  for (const Dimensions& box : std::vector<Dimensions>{{9, 9, 9}, {33, 17, 20}, {40, 34, 12}}) {
    for (const float hole : {kMissing, std::numeric_limits<float>::infinity()}) {
      const MemoryVolume<float> volume(box, [&](LatticePoint p) {
        return missing.contains(p) ? hole : static_cast<float>(4 * p.i + 2 * p.j - p.k);
      });
      OpenStore<float> store(volume);
      const int lods = store.pages().grid().depth();
      const IndexedHierarchy full = test::DiamondTable(store).full_mesh();
      for (const double isovalue : {15.5, 31.0, 40.25, 47.25}) {
        SCOPED_TRACE(testing::Message()
                     << box[0] << " x " << box[1] << " x " << box[2] << ", isovalue " << isovalue);
        SurfaceRequest request;
        request.isovalue = isovalue;
        request.least_parameter = 0;
        const Contour found = store.extract(request).contour;
        const Contour wanted =
            extract_contour(full, test::field_of(volume, lods), isovalue, test::options_of(volume, lods, 0));
        ASSERT_GT(wanted.triangles.size(), 0u);
        test::expect_near(test::measure(found), test::measure(wanted),
                          1e-8 * (1 + test::measure(wanted).area));
        if (box[0] > 9) {
          EXPECT_LT(found.triangles.size(), wanted.triangles.size());
        }
      }
    }
  }
}

/// Returns the greatest difference between samples and interpolation in the closed tetrahedra of a diamond.
double greatest_difference(const MemoryVolume<float>& volume, int depth, LatticePoint point) {
  const Diamond diamond(point);
  const int shift = kRootBits - depth;
  double greatest = 0;
  for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
    std::array<Vec3, 4> corners;
    std::array<double, 4> values{};
    Box3 box;
    for (std::size_t v = 0; v < 4; ++v) {
      const LatticePoint p = diamond.tetrahedron(slot)[v];
      const LatticePoint at{p.i >> shift, p.j >> shift, p.k >> shift};
      corners[v] = {double(at.i), double(at.j), double(at.k)};
      values[v] = volume.at(at);
      box.extend(corners[v]);
    }
    const double whole = signed_volume(corners[0], corners[1], corners[2], corners[3]);
    for (double z = box.min.z; z <= box.max.z; ++z)
      for (double y = box.min.y; y <= box.max.y; ++y)
        for (double x = box.min.x; x <= box.max.x; ++x) {
          const LatticePoint p{int(x), int(y), int(z)}, end = volume.last();
          if (p.i < 0 || p.j < 0 || p.k < 0 || p.i > end.i || p.j > end.j || p.k > end.k) continue;
          double value = 0, least = 1;
          for (std::size_t v = 0; v < 4; ++v) {
            auto other = corners;
            other[v] = {x, y, z};
            const double weight = signed_volume(other[0], other[1], other[2], other[3]) / whole;
            least = std::min(least, weight);
            value += weight * values[v];
          }
          if (least > -1e-9) greatest = std::max(greatest, std::abs(value - volume.at(p)));
        }
  }
  return greatest;
}

/// On the surface without error the approximation differs from the isovalue by at most the greatest
/// difference between the samples in its cell and the interpolation there.
TEST(SurfaceExtractor, DiffersNoMoreThanTheSamplesOfItsCells) {
  const MemoryVolume<float> volume = hills<float>({33, 20, 26}, 1, {1, 1.5, 0.75});
  OpenStore<float> store(volume);
  const int depth = store.pages().grid().depth();
  const auto field = test::field_of(volume, depth);
  const double isovalue = 110;
  SurfaceRequest exact;
  exact.isovalue = isovalue;
  exact.least_parameter = 0;
  const test::DiamondTable table(store);
  const std::vector<Vec3> points = test::points_on(store.extract(exact).contour);
  ASSERT_GT(points.size(), 1000u);
  for (const double error : {0.1, 0.5, 2.0, 8.0}) {
    const IndexedHierarchy mesh = table.mesh(isovalue, error);
    const test::MeshFunction function(mesh, field);
    std::map<LatticePoint, double> bounds;
    double greatest = 0;
    for (const Vec3& p : points) {
      const auto [diamond, value] = function.at(p);
      const auto [bound, is_new] = bounds.try_emplace(diamond, 0);
      if (is_new) bound->second = greatest_difference(volume, depth, diamond);
      greatest = std::max(greatest, std::abs(value - isovalue));
      ASSERT_LE(std::abs(value - isovalue), bound->second + 1e-9) << "error " << error;
    }
    EXPECT_GT(greatest, 0) << "error " << error;
  }
}

TEST(SurfaceExtractor, ReportsTheRangeAndTheDomain) {
  const MemoryVolume<std::int16_t> volume({20, 9, 5}, [](LatticePoint p) { return p.i * p.i - 50 * p.k; },
                                          {1, 2, 3}, {-1, -2, -3});
  OpenStore<std::int16_t> store(volume);
  EXPECT_EQ(store.extractor().range(), (std::array{-200.0, 361.0}));
  EXPECT_EQ(store.extractor().domain().box().min, (Vec3{-1, -2, -3}));
  EXPECT_EQ(store.extractor().domain().box().max, (Vec3{31, 62, 93}));
}

}  // namespace
}  // namespace adamas
