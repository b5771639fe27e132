#include "isosurface/volume/page_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/base/error.h"

namespace adamas {

using namespace isosurface;

namespace {

std::vector<PageId> all_pages(const PageGrid& grid) {
  std::vector<PageId> pages;
  for (int lod = grid.top(); lod >= 0; --lod) {
    const LatticePoint n = grid.blocks(lod);
    for (std::int32_t k = 0; k < n.k; ++k)
      for (std::int32_t j = 0; j < n.j; ++j)
        for (std::int32_t i = 0; i < n.i; ++i) {
          const PageId page{lod, {i, j, k}};
          if (grid.contains(page)) pages.push_back(page);
        }
  }
  return pages;
}

/// Returns the number of points of the page that no other page has, by brute force.
std::size_t own_points(const PageGrid& grid, const PageId& page) {
  const LatticePoint n = grid.count(page);
  std::size_t count = 0;
  for (std::int32_t k = 0; k < n.k; ++k)
    for (std::int32_t j = 0; j < n.j; ++j)
      for (std::int32_t i = 0; i < n.i; ++i)
        count += grid.is_complete(page) || ((i | j | k) & 1) != 0 ? 1 : 0;
  return count;
}

class PageGridOf : public testing::TestWithParam<std::array<std::uint64_t, 3>> {};

TEST_P(PageGridOf, EverySampleIsInOnePage) {
  const PageGrid grid(GetParam());
  const std::vector<PageId> pages = all_pages(grid);
  EXPECT_EQ(pages.size(), grid.page_count());
  std::map<std::uint64_t, std::set<std::size_t>> places;
  const LatticePoint last = grid.last();
  for (std::int32_t k = 0; k <= last.k; ++k)
    for (std::int32_t j = 0; j <= last.j; ++j)
      for (std::int32_t i = 0; i <= last.i; ++i) {
        const LatticePoint p{i, j, k};
        const PageId page = grid.page(p);
        ASSERT_TRUE(grid.contains(page));
        const std::size_t place = PageGrid::place(p, page.lod);
        ASSERT_TRUE(grid.is_complete(page) || (place & 0x111) != 0);
        ASSERT_TRUE(places[grid.number(page)].insert(place).second) << "two samples in one place";
      }
  for (const PageId& page : pages) {
    EXPECT_GT(own_points(grid, page), 0u);
    EXPECT_GE(own_points(grid, page), places[grid.number(page)].size());
    EXPECT_EQ(grid.page(grid.number(page)), page);
  }
}

TEST_P(PageGridOf, LodsReachAsFarAsTheDiamondsThatReachTheData) {
  const PageGrid grid(GetParam());
  for (int lod = 0; lod < grid.depth(); ++lod) {
    const std::int32_t s = 1 << lod;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t last = grid.last()[axis], end = grid.reach(lod)[axis];
      if (last == 0) continue;
      EXPECT_LT((end - 1) * s, last);      // the diamond of the last point begins before the data end,
      EXPECT_GE((end + 1 - 1) * s, last);  // and that of the next one does not
    }
  }
}

TEST_P(PageGridOf, PagesHaveThePointsWhoseDiamondsReachTheData) {
  const PageGrid grid(GetParam());
  for (int lod = 0; lod < grid.depth(); ++lod) {
    const int in_pages = std::min(lod, grid.top());
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_LE(grid.reach(lod)[axis] << (lod - in_pages), grid.extent(in_pages)[axis]) << lod;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Dimensions, PageGridOf,
    testing::Values(std::array<std::uint64_t, 3>{1, 1, 1}, std::array<std::uint64_t, 3>{2, 1, 3},
                    std::array<std::uint64_t, 3>{16, 16, 16}, std::array<std::uint64_t, 3>{17, 17, 17},
                    std::array<std::uint64_t, 3>{33, 18, 5}, std::array<std::uint64_t, 3>{65, 64, 63},
                    std::array<std::uint64_t, 3>{100, 1, 37}));

TEST(PageGrid, NumbersPutCoarsePagesFirst) {
  const PageGrid grid({200, 200, 200});
  const std::vector<PageId> pages = all_pages(grid);
  for (const PageId& page : pages)
    for (const PageId& other : {pages.front(), pages.back()}) {
      if (page.lod > other.lod) {
        EXPECT_LT(grid.number(page), grid.number(other));
      }
    }
  EXPECT_EQ(grid.number(pages.front()), 1u);
}

TEST(PageGrid, RefusesWhatItCannotHold) {
  EXPECT_THROW(PageGrid({0, 1, 1}), Error);
  EXPECT_THROW(PageGrid({1, 1, (1u << 18) + 2}), Error);
  EXPECT_EQ(PageGrid({1, 1, (1u << 18) + 1}).depth(), 18);
}

}  // namespace
}  // namespace adamas
