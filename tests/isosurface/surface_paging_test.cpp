#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/isosurface/contour_checks.h"
#include "tests/isosurface/surface_checks.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::MemoryVolume;
using test::OpenStore;

MemoryVolume<std::int16_t> hills() {
  return {{70, 66, 50}, [random = std::mt19937(6)](LatticePoint p) mutable {
            return 9000 * std::sin(0.25 * p.i + 0.1 * p.k) * std::cos(0.2 * p.j + 0.05 * p.k) +
                   static_cast<double>(random() % 200);
          }};
}

std::vector<SurfaceRequest> requests() {
  std::vector<SurfaceRequest> all;
  for (const double isovalue : {0.0, 3000.5, -5000.0}) {
    for (const double error : {0.0, 0.7}) {
      SurfaceRequest request;
      request.isovalue = isovalue;
      request.error = error;
      all.push_back(request);
    }
  }
  all.push_back(all.front());
  all.back().max_triangles = 3000;
  all.push_back(all.front());
  all.back().region = Box3{{10, 5, 7}, {30.5, 40, 29}};
  return all;
}

void expect_same(const ExtractedSurface& a, const ExtractedSurface& b) {
  EXPECT_EQ(a.contour, b.contour);
  EXPECT_EQ(a.diamonds, b.diamonds);
  EXPECT_EQ(a.tetrahedra, b.tetrahedra);
  EXPECT_EQ(a.max_error, b.max_error);
}

/// The surface depends on the store and the request alone, not on earlier requests, on memory, or on how
/// pages come.
TEST(SurfacePaging, HistoryAndMemoryDoNotMatter) {
  OpenStore<std::int16_t> store(hills());
  std::vector<ExtractedSurface> wanted;
  for (const SurfaceRequest& request : requests()) {
    store.open();
    wanted.push_back(store.extract(request));
    EXPECT_FALSE(wanted.back().contour.triangles.empty());
  }
  for (const Paging paging : {Paging::kRead, Paging::kMap}) {
    for (const std::size_t memory : {std::size_t{0}, OpenStore<std::int16_t>::kMemory}) {
      store.open(memory, paging);
      for (std::size_t n = 0; n < wanted.size(); ++n) expect_same(store.extract(requests()[n]), wanted[n]);
      for (std::size_t n = wanted.size(); n-- > 0;) expect_same(store.extract(requests()[n]), wanted[n]);
    }
  }
  EXPECT_EQ(store.pages().counts().damaged, 0u);
}

/// Returns data with a small feature that are otherwise below the isovalue.
MemoryVolume<std::uint8_t> small_feature() {
  return {{130, 130, 130}, [random = std::mt19937(6)](LatticePoint p) mutable {
            const double away = std::hypot(p.i - 100, p.j - 36, p.k - 70);
            return away < 6 ? 200 - 10 * away : static_cast<double>(random() % 40);
          }};
}

TEST(SurfacePaging, PagesWithoutTheIsovalueAreNotRead) {
  const MemoryVolume<std::uint8_t> volume = small_feature();
  OpenStore<std::uint8_t> store(volume);
  const ExtractedSurface surface = store.extract(170);
  test::expect_sound(surface.contour, volume.grid.box());
  EXPECT_TRUE(test::border_edges(surface.contour).empty());
  EXPECT_GT(surface.contour.triangles.size(), 50u);
  const PageReads counts = store.pages().counts();
  const std::uint64_t all = store.pages().grid().page_count();
  EXPECT_LT(10 * (counts.pages + counts.predictors), all);
  EXPECT_LT(10 * counts.bytes, store.file().size());
  store.open();
  EXPECT_TRUE(store.extract(250).contour.triangles.empty());
  EXPECT_LE(store.pages().counts().pages, 1u);
  store.open();
  EXPECT_EQ(store.extractor().range()[0], 0);
  EXPECT_EQ(store.pages().counts().pages, 0u) << "the directory tells";
}

TEST(SurfacePaging, CoarseSurfacesReadFewPages) {
  OpenStore<std::uint8_t> store(small_feature());
  store.extract(20, 30);
  const PageReads coarse = store.pages().counts();
  EXPECT_LT(20 * (coarse.pages + coarse.predictors), store.pages().grid().page_count());
}

}  // namespace
}  // namespace adamas
