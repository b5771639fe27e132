#include "isosurface/extraction/split_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/volume_store.h"

namespace adamas {

using namespace isosurface;

namespace {

using Word = std::uint8_t;

test::MemoryVolume<Word> hilly_volume() {
  return {{70, 45, 38}, [](LatticePoint p) {
            return 120 + 60 * std::sin(0.21 * p.i) * std::cos(0.17 * p.j + 0.1 * p.k) +
                   30 * std::sin(0.9 * p.k);
          }};
}

/// The diamonds that are split, and the greatest error code of those that are not.
struct Found {
  std::vector<LatticePoint> split;  ///< lattice points, in the order of pages
  int greatest_left = 0;
  bool operator==(const Found&) const = default;
};

Found found_by(SplitPages<Word>& pages, const SurfaceCut& cut) {
  Found found;
  std::size_t visited = 0;
  pages.find(cut, [&](const SplitPage& page) { visited += page.split->count(); });
  pages.for_each_page([&](const SplitPage& page) {
    page.split->for_each([&](LatticePoint q) { found.split.push_back(pages.in_lattice(page, q)); });
  });
  EXPECT_EQ(visited, pages.count());
  EXPECT_EQ(found.split.size(), pages.count());
  found.greatest_left = pages.greatest_left();
  return found;
}

SurfaceCut any_cut(std::mt19937& random, int lods) {
  SurfaceCut cut;
  cut.error_class = static_cast<int>(1 + random() % static_cast<unsigned>(4 * lods + 24));
  if (random() % 3 == 0) return cut;
  cut.generation = static_cast<int>(random() % static_cast<unsigned>(3 * lods + 1));
  if (random() % 2 == 0) return cut;
  cut.page = random() % 64;
  cut.place = random() % PageGrid::kPoints;
  return cut;
}

TEST(SplitPages, OneCutAfterAnotherFindsWhatEachDoesAlone) {
  test::OpenStore<Word> store(hilly_volume());
  StoredDiamonds<Word> diamonds(store.pages());
  const SurfaceRequest surface;
  std::mt19937 random(5);
  for (const double isovalue : {100.0, 150.0}) {
    diamonds.set_contour(isovalue);
    SplitLimits limits;
    for (const bool in_region : {false, true}) {
      if (in_region) limits.region = {Vec3{10, 0, 5}, Vec3{40, 30, 20}};
      SplitPages<Word> in_turn(diamonds, surface, limits);
      in_turn.forget(true);
      for (int step = 0; step < 60; ++step) {
        const SurfaceCut cut = any_cut(random, diamonds.lods());
        SplitPages<Word> alone(diamonds, surface, limits);
        const Found expected = found_by(alone, cut);
        const Found found = found_by(in_turn, cut);
        ASSERT_EQ(found.split, expected.split);
        ASSERT_EQ(found.greatest_left, expected.greatest_left);
        for (const LatticePoint p : found.split) {
          const auto [lod, block, on_page] = diamonds.place(p);
          ASSERT_NE(in_turn.split_of(lod, block), nullptr);
          ASSERT_TRUE(in_turn.split_of(lod, block)->has(on_page));
        }
      }
    }
  }
}

TEST(SplitPages, SplitWhatTheCutComesTo) {
  test::OpenStore<Word> store(hilly_volume());
  StoredDiamonds<Word> diamonds(store.pages());
  const SurfaceRequest surface;
  diamonds.set_contour(120);
  const SplitLimits limits;
  SplitPages<Word> pages(diamonds, surface, limits);
  pages.forget(true);
  const Found all = found_by(pages, {.error_class = 1});
  ASSERT_GT(all.split.size(), 10'000u);
  EXPECT_EQ(all.greatest_left, 0);
  std::mt19937 random(6);
  for (int step = 0; step < 40; ++step) {
    const SurfaceCut cut{.error_class = static_cast<int>(1 + random() % 40)};
    std::vector<LatticePoint> expected;
    std::copy_if(all.split.begin(), all.split.end(), std::back_inserter(expected),
                 [&](LatticePoint p) { return diamonds.class_if_crossed(p) >= cut.error_class; });
    EXPECT_EQ(found_by(pages, cut).split, expected);
  }
}

}  // namespace
}  // namespace adamas
