#include "isosurface/storage/page_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "isosurface/storage/scratch_pages.h"

namespace adamas {
namespace {

/// Any function of a point of a level that the tree may not know beforehand.
std::uint16_t sample_at(LatticePoint p) { return static_cast<std::uint16_t>(hash_value(p) >> 40); }

/// Fills the own points of a page.
bool fill_own(const PageId& id, const PageShape& shape, Page<std::uint16_t>& page) {
  LatticePoint q{};
  for (q.k = 0; q.k < shape.count.k; ++q.k)
    for (q.j = 0; q.j < shape.count.j; ++q.j)
      for (q.i = 0; q.i < shape.count.i; ++q.i) {
        if (!shape.owns(q)) continue;
        const std::size_t place = PageGrid::place(q, 0);
        page.samples[place] = sample_at((1 << id.level) * (PageGrid::kSide * id.block + q));
        page.low[place] = static_cast<std::uint16_t>(page.samples[place] ^ 1);
        page.high[place] = static_cast<std::uint16_t>(page.samples[place] ^ 2);
        page.errors[place] = static_cast<std::uint8_t>(page.samples[place] & 63);
      }
  return true;
}

class PageTreeOf : public testing::TestWithParam<std::array<std::uint64_t, 3>> {
 protected:
  /// Whether all points of the page are right, those of coarser levels too.
  static void check(const PageGrid& grid, const PageId& id, const Page<std::uint16_t>& page) {
    const LatticePoint n = grid.count(id);
    LatticePoint q{};
    for (q.k = 0; q.k < n.k; ++q.k)
      for (q.j = 0; q.j < n.j; ++q.j)
        for (q.i = 0; q.i < n.i; ++q.i) {
          const std::size_t place = PageGrid::place(q, 0);
          const std::uint16_t expected = sample_at((1 << id.level) * (PageGrid::kSide * id.block + q));
          ASSERT_EQ(page.samples[place], expected);
          ASSERT_EQ(page.low[place], expected ^ 1);
          ASSERT_EQ(page.high[place], expected ^ 2);
          ASSERT_EQ(page.errors[place], expected & 63);
        }
  }

  static std::vector<PageId> pages_in_random_order(const PageGrid& grid) {
    std::vector<PageId> pages;
    for (int level = 0; level <= grid.top(); ++level) {
      const LatticePoint n = grid.blocks(level);
      for (std::int32_t k = 0; k < n.k; ++k)
        for (std::int32_t j = 0; j < n.j; ++j)
          for (std::int32_t i = 0; i < n.i; ++i) pages.push_back({level, {i, j, k}});
    }
    std::mt19937 random(1);
    std::shuffle(pages.begin(), pages.end(), random);
    return pages;
  }
};

TEST_P(PageTreeOf, PagesHaveTheirPointsAndThoseOfCoarserLevels) {
  const PageGrid grid(GetParam());
  std::uint64_t loads = 0;
  PageTree<std::uint16_t> tree(grid, PageParts::kAll, 1 << 20,
                               [&](const PageId& id, const PageShape& shape,
                                   const Surroundings<std::uint16_t>&, Page<std::uint16_t>& page) {
                                 ++loads;
                                 return fill_own(id, shape, page);
                               });
  for (const PageId& id : pages_in_random_order(grid)) {
    const Page<std::uint16_t>* page = tree.page(id);
    ASSERT_NE(page, nullptr);
    check(grid, id, *page);
  }
  EXPECT_EQ(loads, grid.page_count());
  EXPECT_EQ(tree.loaded(), grid.page_count());
  EXPECT_EQ(tree.loaded_as_predictors(), 0u);
}

TEST_P(PageTreeOf, PagesThatLeftComeBack) {
  const PageGrid grid(GetParam());
  PageTree<std::uint16_t> tree(
      grid, PageParts::kAll, 0,
      [&](const PageId& id, const PageShape& shape, const Surroundings<std::uint16_t>&,
          Page<std::uint16_t>& page) { return fill_own(id, shape, page); });
  for (const PageId& id : pages_in_random_order(grid)) {
    const Page<std::uint16_t>* page = tree.page(id);
    ASSERT_NE(page, nullptr);
    check(grid, id, *page);
  }
  EXPECT_GE(tree.loaded(), grid.page_count());
}

TEST_P(PageTreeOf, SurroundingsAreThePointsOfTheNextLevel) {
  const PageGrid grid(GetParam());
  PageTree<std::uint16_t> tree(
      grid, PageParts::kAll, 1 << 20,
      [&](const PageId& id, const PageShape& shape, const Surroundings<std::uint16_t>&,
          Page<std::uint16_t>& page) { return fill_own(id, shape, page); });
  for (const PageId& id : pages_in_random_order(grid)) {
    if (grid.is_complete(id)) continue;
    Surroundings<std::uint16_t> around;
    ASSERT_TRUE(tree.surroundings(id, around));
    const LatticePoint extent = grid.extent(id.level + 1);
    for (std::int32_t c = 0; c < 11; ++c)
      for (std::int32_t b = 0; b < 11; ++b)
        for (std::int32_t a = 0; a < 11; ++a) {
          LatticePoint p{8 * id.block.i + a - 1, 8 * id.block.j + b - 1, 8 * id.block.k + c - 1};
          const std::size_t place = surrounding_place({2 * (a - 1), 2 * (b - 1), 2 * (c - 1)});
          for (int axis = 0; axis < 3; ++axis) p[axis] = std::clamp(p[axis], 0, extent[axis]);
          ASSERT_EQ(around.samples[place], sample_at((2 << id.level) * p));
        }
  }
}

TEST_P(PageTreeOf, ScratchKeepsOwnPoints) {
  const PageGrid grid(GetParam());
  ScratchPages<std::uint16_t> scratch(std::filesystem::temp_directory_path(), grid);
  for (const PageId& id : pages_in_random_order(grid)) {
    if (!grid.contains(id)) continue;
    Page<std::uint16_t> page{};
    fill_own(id, {grid.count(id), grid.is_complete(id), id.level}, page);
    scratch.put(id, page);
  }
  PageTree<std::uint16_t> tree(
      grid, PageParts::kAll, 100,
      [&](const PageId& id, const PageShape&, const Surroundings<std::uint16_t>&, Page<std::uint16_t>& page) {
        scratch.get(id, page);
        return true;
      });
  for (const PageId& id : pages_in_random_order(grid)) check(grid, id, *tree.page(id));
}

INSTANTIATE_TEST_SUITE_P(Dimensions, PageTreeOf,
                         testing::Values(std::array<std::uint64_t, 3>{1, 1, 1},
                                         std::array<std::uint64_t, 3>{17, 17, 17},
                                         std::array<std::uint64_t, 3>{65, 65, 65},
                                         std::array<std::uint64_t, 3>{33, 100, 5}));

TEST(PageTree, WhatCannotBeHadTakesWhatIsPredictedFromItAlong) {
  const PageGrid grid({100, 100, 100});
  const PageId bad{1, {1, 1, 1}};
  PageTree<std::uint16_t> tree(
      grid, PageParts::kAll, 1 << 20,
      [&](const PageId& id, const PageShape& shape, const Surroundings<std::uint16_t>&,
          Page<std::uint16_t>& page) { return id != bad && fill_own(id, shape, page); });
  EXPECT_EQ(tree.page(bad), nullptr);
  EXPECT_EQ(tree.page({0, {2, 2, 2}}), nullptr);
  EXPECT_NE(tree.page({0, {0, 0, 0}}), nullptr);
  EXPECT_EQ(tree.page({0, {1, 1, 1}}), nullptr);  // one coarse point beyond its end
  EXPECT_NE(tree.page({0, {5, 0, 0}}), nullptr);
  EXPECT_GT(tree.loaded_as_predictors(), 0u);
}

}  // namespace
}  // namespace adamas
