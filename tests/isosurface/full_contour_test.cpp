#include "isosurface/extraction/full_contour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "isosurface/contour/join_points.h"
#include "tests/isosurface/contour_checks.h"
#include "tests/isosurface/surface_checks.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::Dimensions;
using test::MemoryVolume;
using test::OpenStore;

/// Returns what two surfaces with the same points in different orders have in common: each triangle as the
/// ranks of its corners among the points sorted by their coordinates.
std::multiset<std::array<std::size_t, 3>> triangles_in_space(const Contour& contour) {
  std::vector<std::size_t> order(contour.points.size()), places(contour.points.size());
  for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
  const auto at = [&](std::size_t n) {
    const Vec3& p = contour.points[n];
    const auto rounded = [](double x) { return std::round(1e8 * x); };
    return std::array{rounded(p.x), rounded(p.y), rounded(p.z)};
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return at(a) < at(b); });
  for (std::size_t n = 0; n < order.size(); ++n) places[order[n]] = n;
  std::multiset<std::array<std::size_t, 3>> result;
  for (const auto& [a, b, c] : contour.triangles) {
    std::array<std::size_t, 3> t{places[a], places[b], places[c]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    result.insert(t);
  }
  return result;
}

template <class Sample>
Contour full_contour(OpenStore<Sample>& store, double isovalue) {
  StoredDiamonds<Sample> diamonds(store.pages());
  diamonds.set_contour(isovalue);
  const SplitLimits limits;
  FullContour<Sample> full(diamonds, isovalue, 1.0 / 1024, limits);
  const std::optional<Contour> found = full.run(SilentProgress::instance());
  EXPECT_TRUE(found.has_value());
  return *found;
}

/// Returns the joined contour of the mesh in which everything is split, over the data alone and without
/// clipping.
template <class Sample>
Contour joined_full_contour(OpenStore<Sample>& store, const MemoryVolume<Sample>& volume, double isovalue) {
  const int lods = store.pages().grid().depth();
  ContourOptions options = test::options_of(volume, lods, 1.0 / 1024);
  const LatticePoint last = *options.last_sample;
  const auto inside = [&, field = test::field_of(volume, lods)](LatticePoint p) {
    const bool is_inside = p.i <= last.i && p.j <= last.j && p.k <= last.k;
    return is_inside ? field(p) : std::numeric_limits<double>::quiet_NaN();
  };
  options.last_sample.reset();
  options.join = true;
  return extract_contour(test::DiamondTable(store).full_mesh(), inside, isovalue, options);
}

template <class Sample>
class FullContourOf : public testing::Test {
 protected:
  static void expect_the_joined(const MemoryVolume<Sample>& volume, const std::vector<double>& isovalues,
                                bool is_noise = false) {
    OpenStore<Sample> store(volume);
    for (const double isovalue : isovalues) {
      SCOPED_TRACE(testing::Message() << "isovalue " << isovalue);
      const Contour found = full_contour(store, isovalue);
      const Contour wanted = joined_full_contour(store, volume, isovalue);
      EXPECT_GT(found.triangles.size(), 50u);
      test::expect_closed(found, volume.grid.box());
      EXPECT_EQ(test::topology(found), test::topology(wanted));
      if (is_noise) {
        // Which patches coincide depends on which of them were taken apart before, and slabs begin with their
        // interior.
        const auto all = static_cast<double>(wanted.triangles.size());
        EXPECT_NEAR(static_cast<double>(found.triangles.size()), all, 0.01 * all);
        continue;
      }
      EXPECT_EQ(found.edge_points.size(), wanted.edge_points.size());
      EXPECT_EQ(found.vertex_points.size(), wanted.vertex_points.size());
      EXPECT_TRUE(triangles_in_space(found) == triangles_in_space(wanted))
          << found.triangles.size() << " triangles, not " << wanted.triangles.size();
    }
  }
  static MemoryVolume<Sample> noise(const Dimensions& dimensions, unsigned seed) {
    return {dimensions, [random = std::mt19937(seed)](LatticePoint) mutable { return random() % 251; }};
  }
  static MemoryVolume<Sample> hills(const Dimensions& dimensions, double noise, const Vec3& spacing) {
    return {dimensions,
            [&, noise, random = std::mt19937(6)](LatticePoint p) mutable {
              return 100 + 60 * std::sin(0.35 * p.i + 0.2 * p.k) * std::cos(0.3 * p.j) +
                     noise * static_cast<double>(random() % 1024) / 1024;
            },
            spacing,
            {5, -3, 2}};
  }
};
using Samples = testing::Types<std::uint8_t, std::uint16_t, std::int16_t, float>;
TYPED_TEST_SUITE(FullContourOf, Samples);

TYPED_TEST(FullContourOf, IsTheJoinedContourOfTheFullMesh) {
  this->expect_the_joined(this->hills({35, 19, 40}, 30, {1, 1, 1}), {70, 128});
  this->expect_the_joined(this->hills({33, 33, 17}, 3, {1, 2, 0.5}), {100});
  // In noise many patches are not discs, or would coincide with others when they are joined.
  this->expect_the_joined(this->noise({36, 18, 34}, 1), {20.5, 128}, true);
  this->expect_the_joined(this->noise({19, 34, 17}, 2), {5, 240}, true);
}

/// The contour round one sample is a whole body, wherever the sample lies on its page, also beside pages that
/// the contour does not cross.
TEST(FullContour, HasBodiesOfOneSampleAtBordersOfPages) {
  for (const LatticePoint at : std::vector<LatticePoint>{
           {16, 16, 16}, {16, 15, 17}, {15, 16, 8}, {31, 16, 16}, {32, 32, 32}, {17, 31, 15}, {0, 16, 7}}) {
    const MemoryVolume<std::uint8_t> volume({40, 40, 40},
                                            [at](LatticePoint p) { return p == at ? 200 : 10; });
    OpenStore<std::uint8_t> store(volume);
    const Contour found = full_contour(store, 100);
    test::expect_closed(found, volume.grid.box());
    EXPECT_EQ(test::topology(found), std::vector<int>{at.i == 0 ? 1 : 2});
    EXPECT_TRUE(triangles_in_space(found) == triangles_in_space(joined_full_contour(store, volume, 100)));
  }
}

/// Slabs are distributed over threads, and their common layers are joined afterwards.
TEST(FullContour, IsTheSameOnAnyNumberOfThreads) {
  const MemoryVolume<std::uint8_t> volume({40, 36, 200}, [random = std::mt19937(8)](LatticePoint p) mutable {
    return 100 + 60 * std::sin(0.35 * p.i + 0.2 * p.k) * std::cos(0.3 * p.j) + random() % 40;
  });
  std::vector<Contour> found;
  for (const unsigned threads : {1u, 2u, 3u, 7u}) {
    set_thread_limit(threads);
    OpenStore<std::uint8_t> store(volume);
    found.push_back(full_contour(store, 120));
    EXPECT_TRUE(found.back() == found.front()) << threads;
  }
  set_thread_limit(0);
  test::expect_closed(found.front(), volume.grid.box());
}

TEST(FullContour, IsNoneWhereSamplesAreNotFinite) {
  const MemoryVolume<float> volume({20, 20, 20}, [](LatticePoint p) {
    return p == LatticePoint{7, 8, 9} ? std::numeric_limits<double>::quiet_NaN() : p.i + 0.1 * p.j * p.k;
  });
  OpenStore<float> store(volume);
  StoredDiamonds<float> diamonds(store.pages());
  diamonds.set_contour(8);
  const SplitLimits limits;
  EXPECT_FALSE(FullContour<float>(diamonds, 8, 0, limits).run(SilentProgress::instance()).has_value());
}

}  // namespace
}  // namespace adamas
