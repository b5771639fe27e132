#include "isosurface/extraction/mesh_contour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/base/parallel.h"
#include "tests/isosurface/contour_checks.h"
#include "tests/isosurface/surface_checks.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::MemoryVolume;
using test::OpenStore;

constexpr std::array<unsigned, 4> kThreads{1, 2, 3, 7};

/// Returns hills with noise, on enough pages for seven threads.
template <class Sample>
MemoryVolume<Sample> hills() {
  return {{60, 52, 190}, [random = std::mt19937(8)](LatticePoint p) mutable {
            return 100 + 60 * std::sin(0.35 * p.i + 0.2 * p.k) * std::cos(0.3 * p.j) +
                   static_cast<double>(random() % 12);
          }};
}

void expect_equal(const ExtractedSurface& found, const ExtractedSurface& wanted) {
  EXPECT_TRUE(found.contour == wanted.contour);
  EXPECT_EQ(found.diamonds, wanted.diamonds);
  EXPECT_EQ(found.tetrahedra, wanted.tetrahedra);
  EXPECT_EQ(found.max_error, wanted.max_error);
  EXPECT_EQ(found.lost, wanted.lost);
}

/// Runs of pages are distributed over threads, and the points that they share are identified afterwards.
TEST(LongMeshContour, IsTheSameOnAnyNumberOfThreads) {
  const MemoryVolume<std::uint8_t> volume = hills<std::uint8_t>();
  std::vector<SurfaceRequest> requests;
  for (const double error : {0.0, 0.4, 2.0}) {
    for (const bool join : {false, true}) {
      requests.emplace_back();
      requests.back().isovalue = 110.5;
      requests.back().error = error;
      requests.back().join = join;
    }
  }
  requests.push_back(requests.back());
  requests.back().error = 0.4;
  requests.back().region = Box3{{10, 5, 20}, {50, 40, 150}};
  std::vector<ExtractedSurface> wanted;
  for (const unsigned threads : kThreads) {
    SCOPED_TRACE(testing::Message() << threads << " threads");
    set_thread_limit(threads);
    OpenStore<std::uint8_t> store(volume);
    for (std::size_t n = 0; n < requests.size(); ++n) {
      const ExtractedSurface found = store.extract(requests[n]);
      if (threads == 1) {
        EXPECT_GT(found.contour.triangles.size(), 5000u);
        wanted.push_back(found);
      }
      expect_equal(found, wanted[n]);
    }
  }
  set_thread_limit(0);
}

TEST(LongMeshContour, IsTheSameWhereSamplesAreNotFinite) {
  const MemoryVolume<float> hills_of_floats = hills<float>();
  const MemoryVolume<float> volume({60, 52, 190}, [&, random = std::mt19937(3)](LatticePoint p) mutable {
    return random() % 5000 == 0 ? std::numeric_limits<double>::quiet_NaN() : hills_of_floats.at(p);
  });
  SurfaceRequest request;
  request.isovalue = 110.5;
  request.error = 0.3;
  request.join = true;
  ExtractedSurface wanted;
  for (const unsigned threads : kThreads) {
    SCOPED_TRACE(testing::Message() << threads << " threads");
    set_thread_limit(threads);
    OpenStore<float> store(volume);
    const ExtractedSurface found = store.extract(request);
    if (threads == 1) wanted = found;
    expect_equal(found, wanted);
  }
  set_thread_limit(0);
}

/// Which pages are lost to a surface does not depend on which thread meets with the damage first.
TEST(LongMeshContour, LosesTheSamePagesOnAnyNumberOfThreads) {
  OpenStore<std::uint8_t> store(hills<std::uint8_t>());
  std::string bytes = test::bytes_of(store.path());
  std::size_t damaged = 0;
  for (const LatticePoint block : {LatticePoint{1, 1, 1}, {2, 1, 3}, {1, 2, 8}, {2, 2, 10}, {1, 0, 11}}) {
    const PageId id{0, block};
    const PageEntry entry = store.file().entry(0, id).value();
    ASSERT_NE(entry.offset, 0u);
    bytes[entry.offset + entry.size / 2] ^= 4;
    ++damaged;
  }
  test::put_bytes(store.path(), bytes);
  for (const double error : {0.0, 0.3}) {
    SurfaceRequest request;
    request.isovalue = 110.5;
    request.error = error;
    request.join = true;
    ExtractedSurface wanted;
    for (const unsigned threads : kThreads) {
      SCOPED_TRACE(testing::Message() << threads << " threads, error " << error);
      set_thread_limit(threads);
      store.open();
      const ExtractedSurface found = store.extract(request);
      if (threads == 1) wanted = found;
      EXPECT_EQ(found.lost.size(), damaged);
      expect_equal(found, wanted);
    }
  }
  set_thread_limit(0);
}

}  // namespace
}  // namespace adamas
