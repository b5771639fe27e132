#include "isosurface/storage/page_cache.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <utility>

#include "isosurface/storage/scratch_pages.h"

namespace adamas {

using namespace isosurface;

namespace {

/// Returns a sample as a hash of the point, which a cache cannot know in advance.
std::uint16_t sample_at(LatticePoint p) { return static_cast<std::uint16_t>(hash_value(p) >> 40); }

using Word = std::uint16_t;

/// Fills the missing parts of a page's own points.
void fill_own(const PageToLoad<Word>& page) {
  LatticePoint q{};
  for (q.k = 0; q.k < page.shape.count.k; ++q.k)
    for (q.j = 0; q.j < page.shape.count.j; ++q.j)
      for (q.i = 0; q.i < page.shape.count.i; ++q.i) {
        if (!page.shape.owns(q)) continue;
        const std::size_t place = PageGrid::place(q, 0);
        const Word sample = sample_at((1 << page.id.lod) * (PageGrid::kSide * page.id.block + q));
        if (has_part(page.parts, PageParts::kSamples)) page.samples.samples[place] = sample;
        EXPECT_EQ(page.samples.samples[place], sample);
        EXPECT_EQ(page.bounds != nullptr, has_part(page.parts, PageParts::kBounds));
        if (page.bounds == nullptr) continue;
        page.bounds->low[place] = static_cast<Word>(sample ^ 1);
        page.bounds->high[place] = static_cast<Word>(sample ^ 2);
        page.bounds->errors[place] = static_cast<std::uint8_t>(sample & 63);
      }
}

/// A cache whose pages are filled by fill_own; pages for which `can_load` returns false cannot be loaded.
class FilledPages : public PageCache<Word> {
 public:
  using CanLoad = std::function<bool(const PageId&, PageParts)>;
  FilledPages(
      const PageGrid& grid, std::size_t memory,
      CanLoad can_load = [](const PageId&, PageParts) { return true; })
      : PageCache(grid, memory), can_load_(std::move(can_load)) {}

 private:
  bool load(const PageToLoad<Word>& page) override {
    fill_own(page);
    return can_load_(page.id, page.parts);
  }
  CanLoad can_load_;
};

class PageCacheOf : public testing::TestWithParam<std::array<std::uint64_t, 3>> {
 protected:
  /// Expects that the samples or the bounds of all points of the page are right, those of coarser LODs
  /// included.
  static void check_samples(const PageGrid& grid, const PageId& id, const PagePoints<Word>& samples) {
    for_each_point(grid, id, [&](std::size_t place, Word expected) { ASSERT_EQ(samples[place], expected); });
  }
  static void check_bounds(const PageGrid& grid, const PageId& id, const PageBounds<Word>& bounds) {
    for_each_point(grid, id, [&](std::size_t place, Word expected) {
      ASSERT_EQ(bounds.low[place], expected ^ 1);
      ASSERT_EQ(bounds.high[place], expected ^ 2);
      ASSERT_EQ(bounds.errors[place], expected & 63);
    });
  }
  static void check(const PageGrid& grid, const PageId& id, PageCache<Word>& cache) {
    const auto page = std::make_unique<Page<Word>>();
    ASSERT_TRUE(cache.copy(id, *page));
    check_samples(grid, id, page->samples);
    check_bounds(grid, id, *page);
  }

  static std::vector<PageId> pages_in_random_order(const PageGrid& grid) {
    std::vector<PageId> pages;
    for (int lod = 0; lod <= grid.top(); ++lod) {
      const LatticePoint n = grid.blocks(lod);
      for (std::int32_t k = 0; k < n.k; ++k)
        for (std::int32_t j = 0; j < n.j; ++j)
          for (std::int32_t i = 0; i < n.i; ++i) pages.push_back({lod, {i, j, k}});
    }
    std::mt19937 random(1);
    std::shuffle(pages.begin(), pages.end(), random);
    return pages;
  }

 private:
  template <class Visit>
  static void for_each_point(const PageGrid& grid, const PageId& id, Visit visit) {
    const LatticePoint n = grid.count(id);
    LatticePoint q{};
    for (q.k = 0; q.k < n.k; ++q.k)
      for (q.j = 0; q.j < n.j; ++q.j)
        for (q.i = 0; q.i < n.i; ++q.i)
          visit(PageGrid::place(q, 0), sample_at((1 << id.lod) * (PageGrid::kSide * id.block + q)));
  }
};

TEST_P(PageCacheOf, PagesHaveTheirPointsAndThoseOfCoarserLods) {
  const PageGrid grid(GetParam());
  std::uint64_t loads = 0;
  FilledPages cache(grid, std::size_t{1} << 40, [&loads](const PageId&, PageParts parts) {
    loads += has_part(parts, PageParts::kSamples) ? 1 : 0;
    return true;
  });
  for (const PageId& id : pages_in_random_order(grid)) check(grid, id, cache);
  EXPECT_EQ(loads, grid.page_count());
  EXPECT_EQ(cache.loaded(), grid.page_count());
  EXPECT_EQ(cache.loaded_as_predictors(), 0u);
}

TEST_P(PageCacheOf, SamplesAloneNeedNoBounds) {
  const PageGrid grid(GetParam());
  FilledPages cache(grid, std::size_t{1} << 40,
                    [](const PageId&, PageParts parts) { return parts == PageParts::kSamples; });
  for (const PageId& id : pages_in_random_order(grid)) {
    const PageSamples<Word>* page = cache.samples(id);
    ASSERT_NE(page, nullptr);
    check_samples(grid, id, page->samples);
  }
  EXPECT_EQ(cache.loaded(), grid.page_count());
}

TEST_P(PageCacheOf, PartsThatLeftComeBack) {
  const PageGrid grid(GetParam());
  for (const std::size_t memory : {std::size_t{0}, 100 * sizeof(Page<Word>), std::size_t{1} << 40}) {
    FilledPages cache(grid, memory);
    std::mt19937 random(3);
    std::vector<PageId> pages = pages_in_random_order(grid);
    for (int step = 0; step < 3000; ++step) {
      const PageId& id = pages[random() % pages.size()];
      switch (random() % 8) {
        case 0:
          cache.drop_bounds(id);
          break;
        case 1:
          check(grid, id, cache);
          break;
        case 2:
          if (random() % 64 == 0) cache.drop_bounds();
          break;
        case 3:
          if (const PageSamples<Word>* found = cache.held(id)) check_samples(grid, id, found->samples);
          break;
        case 4:
        case 5:
          check_samples(grid, id, cache.samples(id)->samples);
          break;
        default:
          check_bounds(grid, id, *cache.bounds(id));
      }
      if (HasFatalFailure()) return;
    }
    EXPECT_GE(cache.loaded(), cache.loaded_as_predictors());
  }
}

/// Samples that are copied from another cache equal those that are loaded, and push none of these out.
TEST_P(PageCacheOf, SamplesComeFromAnotherCache) {
  const PageGrid grid(GetParam());
  const std::vector<PageId> pages = pages_in_random_order(grid);
  for (const std::size_t memory : {std::size_t{0}, std::size_t{1} << 40}) {
    FilledPages from(grid, std::size_t{1} << 40), to(grid, memory);
    for (std::size_t n = 0; n < pages.size(); n += 2) from.samples(pages[n]);
    for (std::size_t n = 0; n < pages.size(); n += 3) to.samples(pages[n]);
    const std::uint64_t loaded = to.loaded();
    const std::size_t before = to.held_pages().size();
    const auto others = from.held_pages();
    to.copy_samples(others);
    EXPECT_EQ(to.loaded(), loaded);
    EXPECT_GE(to.held_pages().size(), before);
    for (const auto& page : others) {
      const PageSamples<Word>* const found = memory > 0 ? to.samples(page.id) : to.held(page.id);
      if (found != nullptr) check_samples(grid, page.id, found->samples);
    }
    EXPECT_EQ(to.loaded(), loaded);
    EXPECT_LE(to.loaded_as_predictors(), to.loaded());
    for (const PageId& id : pages) check(grid, id, to);
    EXPECT_LE(to.loaded_as_predictors(), to.loaded());
  }
}

TEST_P(PageCacheOf, SurroundingsAreThePointsOfTheNextLod) {
  const PageGrid grid(GetParam());
  FilledPages cache(grid, std::size_t{1} << 24);
  for (const PageId& id : pages_in_random_order(grid)) {
    if (grid.is_complete(id)) continue;
    Surroundings<Word> around;
    ASSERT_TRUE(cache.surroundings(id, around));
    const LatticePoint extent = grid.extent(id.lod + 1);
    for (std::int32_t c = 0; c < 11; ++c)
      for (std::int32_t b = 0; b < 11; ++b)
        for (std::int32_t a = 0; a < 11; ++a) {
          LatticePoint p{8 * id.block.i + a - 1, 8 * id.block.j + b - 1, 8 * id.block.k + c - 1};
          const std::size_t place = surrounding_place({2 * (a - 1), 2 * (b - 1), 2 * (c - 1)});
          for (int axis = 0; axis < 3; ++axis) p[axis] = std::clamp(p[axis], 0, extent[axis]);
          const Word expected = sample_at((2 << id.lod) * p);
          ASSERT_EQ(around.samples[place], expected);
          const bool is_on_parent = p.i / 16 == id.block.i / 2 && p.j / 16 == id.block.j / 2 &&
                                    p.k / 16 == id.block.k / 2 && std::min({a, b, c}) >= 1 &&
                                    std::max({a, b, c}) <= 9;
          ASSERT_EQ(around.low[place], is_on_parent ? expected ^ 1 : 0);
          ASSERT_EQ(around.high[place], is_on_parent ? expected ^ 2 : 0xffff);
          ASSERT_EQ(around.errors[place], is_on_parent ? expected & 63 : 63);
        }
  }
}

TEST_P(PageCacheOf, ScratchKeepsOwnPoints) {
  const PageGrid grid(GetParam());
  ScratchPages<Word> scratch(std::filesystem::temp_directory_path(), grid, 100);
  for (const PageId& id : pages_in_random_order(grid)) {
    if (!grid.contains(id)) continue;
    Page<Word> page{};
    fill_own({id, page_shape(grid, id), PageParts::kAll, Surroundings<Word>{}, page, &page});
    scratch.put(id, page);
  }
  for (const PageId& id : pages_in_random_order(grid)) {
    check_samples(grid, id, scratch.samples(id)->samples);
    check(grid, id, scratch);
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, PageCacheOf,
                         testing::Values(std::array<std::uint64_t, 3>{1, 1, 1},
                                         std::array<std::uint64_t, 3>{17, 17, 17},
                                         std::array<std::uint64_t, 3>{65, 65, 65},
                                         std::array<std::uint64_t, 3>{33, 100, 5}));

TEST(PageCache, WhatCannotBeHadTakesWhatIsPredictedFromItAlong) {
  const PageGrid grid({100, 100, 100});
  const PageId bad{1, {1, 1, 1}};
  FilledPages cache(grid, std::size_t{1} << 24, [bad](const PageId& id, PageParts) { return id != bad; });
  EXPECT_EQ(cache.samples(bad), nullptr);
  EXPECT_EQ(cache.samples({0, {2, 2, 2}}), nullptr);
  EXPECT_NE(cache.samples({0, {0, 0, 0}}), nullptr);
  EXPECT_EQ(cache.samples({0, {1, 1, 1}}), nullptr);  // one coarse point beyond its end
  EXPECT_NE(cache.samples({0, {5, 0, 0}}), nullptr);
  EXPECT_GT(cache.loaded_as_predictors(), 0u);
}

TEST(PageCache, BoundsThatCannotBeHadLeaveSamples) {
  const PageGrid grid({100, 100, 100});
  const PageId bad{1, {1, 1, 1}};
  FilledPages cache(grid, std::size_t{1} << 24, [bad](const PageId& id, PageParts parts) {
    return id != bad || parts == PageParts::kSamples;
  });
  EXPECT_NE(cache.samples(bad), nullptr);
  EXPECT_EQ(cache.bounds(bad), nullptr);
  EXPECT_EQ(cache.bounds({0, {2, 2, 2}}), nullptr);
  EXPECT_NE(cache.samples({0, {2, 2, 2}}), nullptr);
  EXPECT_NE(cache.bounds({0, {0, 0, 0}}), nullptr);
}

TEST(PageCache, PagesLeaveForMoreImportantOnesAlone) {
  const PageGrid grid({100, 100, 100});
  const PageId coarsest{grid.top(), {0, 0, 0}};
  FilledPages source(grid, std::size_t{1} << 26), cache(grid, 0);
  ASSERT_NE(cache.bounds(coarsest), nullptr);
  cache.set_loading(false);
  std::mt19937 random(8);
  std::map<std::uint64_t, int> needed;  // how much pages in memory are needed, by their numbers
  std::size_t refused = 0, left = 0;
  const auto page = std::make_unique<Page<Word>>();
  for (int n = 0; n < 3000; ++n) {
    if (random() % 100 == 0) {
      cache.forget_needs();
      needed.clear();
    }
    const PageId id{0,
                    {static_cast<std::int32_t>(random() % 7), static_cast<std::int32_t>(random() % 7),
                     static_cast<std::int32_t>(random() % 7)}};
    const int importance = static_cast<int>(random() % 10);
    ASSERT_TRUE(source.copy(id, *page));
    const bool was_there = cache.has(id, PageParts::kSamples), with_bounds = random() % 2 == 0;
    const std::uint64_t left_before = cache.evicted_pages();
    const bool is_put = cache.put(id, *page, with_bounds ? page.get() : nullptr, importance);
    left += cache.evicted_pages() - left_before;
    refused += is_put ? 0 : 1;
    EXPECT_TRUE(is_put || !was_there || with_bounds);
    if (is_put) {
      EXPECT_TRUE(cache.has(id, with_bounds ? PageParts::kAll : PageParts::kSamples));
      ASSERT_NE(cache.held(id), nullptr);
      EXPECT_EQ(cache.held(id)->samples, page->samples);
      needed[grid.number(id)] = std::max(importance, needed[grid.number(id)]);
    }
    EXPECT_TRUE(cache.has(coarsest, PageParts::kAll));
    EXPECT_LE(cache.held_pages().size(), PageMemory<Word>::kLeast);
    std::erase_if(needed, [&](const auto& of) {
      const bool is_there = cache.has(grid.page(of.first), PageParts::kSamples);
      EXPECT_TRUE(is_there || of.second < importance);
      return !is_there;
    });
  }
  EXPECT_GT(refused, 50u);
  EXPECT_GT(left, 100u);
  EXPECT_EQ(cache.samples({0, {6, 6, 6}}) == nullptr, !cache.has({0, {6, 6, 6}}, PageParts::kSamples));
}

}  // namespace
}  // namespace adamas
