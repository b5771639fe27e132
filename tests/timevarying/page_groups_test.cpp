#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "core/base/error.h"
#include "tests/support/test_series.h"
#include "timevarying/read_ahead.h"
#include "timevarying/step_pages.h"
#include "timevarying/verify_store.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

using test::Motion;
using test::TestSeries;

StoreOptions in_groups(std::uint32_t pages, std::uint32_t block_steps) {
  return test::with_blocks(block_steps, SampleCoding::kInterpolation, pages);
}

/// Returns all pages of a store.
std::vector<PageId> pages_of(const PageGrid& grid) {
  std::vector<PageId> pages;
  for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * grid.top()); ++number) {
    if (const PageId id = grid.page(number); grid.contains(id)) pages.push_back(id);
  }
  return pages;
}

template <class Word>
void expect_same_pages(const std::filesystem::path& path, const std::filesystem::path& expected) {
  StoreFile a(path), b(expected);
  ASSERT_EQ(a.steps(), b.steps());
  ASSERT_EQ(a.size(), b.size());
  for (std::uint32_t step = 0; step < a.steps(); ++step) {
    SeriesPages<Word> found(a, step, 1 << 24), wanted(b, step, 1 << 24);
    for (const PageId& id : pages_of(a.grid())) {
      Page<Word> page{}, other{};
      ASSERT_TRUE(found.copy(id, page) && wanted.copy(id, other)) << page_name(id) << " step " << step;
      for_each_own_place(page_shape(a.grid(), id), [&](std::size_t at) {
        ASSERT_TRUE(page.samples[at] == other.samples[at] && page.low[at] == other.low[at] &&
                    page.high[at] == other.high[at] && page.errors[at] == other.errors[at])
            << page_name(id) << " step " << step << " place " << at;
      });
    }
  }
}

TEST(PageGroups, OfAnySizeHoldTheSamePages) {
  const test::Scratch folder;
  const TestSeries<std::uint16_t> series({34, 20, 18}, Motion::kWaves, 11);
  for (const std::uint32_t block : {1u, 4u}) {
    build_series(folder / "one.adm", "one.adm", series.source(), in_groups(1, block));
    for (const std::uint32_t group : {2u, 512u}) {
      SCOPED_TRACE(testing::Message() << "groups of " << group << ", blocks of " << block);
      const auto path = folder / "a.adm";
      build_series(path, "a.adm", series.source(), in_groups(group, block));
      ASSERT_EQ(StoreFile(path).header(10).group_pages, group);
      expect_same_pages<std::uint16_t>(path, folder / "one.adm");
      StoreFile file(path);
      const VerifiedStore verified = verify_store(file, 0, SilentProgress::instance());
      EXPECT_EQ(verified.bad_pages + verified.bad_copies, 0u);
      ASSERT_EQ(test::restored_step_bits<std::uint16_t>(file, 9), test::bits_of(series.steps[9].samples));
      if (HasFatalFailure()) return;
    }
  }
}

TEST(PageGroups, LieStepByStep) {
  const test::Scratch folder;
  const TestSeries<std::uint8_t> series({70, 65, 36}, Motion::kRandom, 5);
  build_series(folder / "a.adm", "a.adm", series.source(), in_groups(8, 4));
  StoreFile file(folder / "a.adm");
  const PageGrid& grid = file.grid();
  std::uint64_t before = 0;
  std::array<std::uint64_t, 3> last{};
  std::map<std::array<std::uint64_t, 3>, std::uint64_t> offsets;  // by group, step and page
  for (const PageId& id : pages_of(grid)) {
    for (std::uint32_t step = 0; step < 4; ++step)
      offsets[{grid.number(id) / 8, step, grid.number(id)}] = file.entry(step, id)->offset;
  }
  for (const auto& [place, offset] : offsets) {
    EXPECT_GT(offset, before) << "page " << place[2] << " behind page " << last[2];
    before = offset;
    last = place;
  }
}

TEST(PageGroups, StayOfOneSizeWhereStepsAreAdded) {
  const test::Scratch folder;
  const TestSeries<std::uint8_t> series({36, 20, 33}, Motion::kWaves, 7);
  build_series(folder / "a.adm", "a.adm", series.source(0, 3), in_groups(8, 4));
  append_series(StoreLock(folder / "a.adm"), series.source(3, 7), in_groups(1, 4));
  for (const std::uint32_t step : {0u, 3u, 6u})
    EXPECT_EQ(StoreFile(folder / "a.adm").header(step).group_pages, 8u);
  build_series(folder / "b.adm", "b.adm", series.source(0, 3), in_groups(1, 4));
  append_series(StoreLock(folder / "b.adm"), series.source(3, 7), in_groups(8, 4));
  EXPECT_EQ(StoreFile(folder / "b.adm").header(6).group_pages, 1u);
  expect_same_pages<std::uint8_t>(folder / "a.adm", folder / "b.adm");
}

/// Returns a directory of random pages of a group, some of which have no bytes.
std::vector<PageEntry> random_group(std::mt19937& random, std::size_t pages, std::size_t steps) {
  std::vector<PageEntry> entries(pages * steps);
  std::uint64_t offset = 1000;
  for (std::size_t step = 0; step < steps; ++step) {
    for (std::size_t page = 0; page < pages; ++page) {
      PageEntry& entry = entries[page * steps + step];
      entry.size = random() % 4 == 0 ? 0 : static_cast<std::uint32_t>(1 + random() % 100);
      entry.offset = offset;
      offset += entry.size;
    }
  }
  return entries;
}

/// A read contains the page that is asked for, consists of whole pages that are not in memory, and is not
/// longer than allowed, unless it has the steps of one page that are needed.
TEST(PageGroups, ReadsAreOfWholePagesThatAreNotInMemory) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 3000; ++trial) {
    const std::size_t pages = std::size_t{1} << random() % 5, steps = 1 + random() % 9;
    const std::vector<PageEntry> entries = random_group(random, pages, steps);
    const PageGroup group(entries, steps);
    PageRuns in_memory;
    for (int n = 0; n < 3; ++n) {
      const PageEntry& known = entries[random() % entries.size()];
      if (known.size > 0)
        in_memory.put(known.offset, std::vector<std::byte>(known.size), std::size_t{1} << 20);
    }
    ReadAhead ahead;
    ahead.bytes = random() % 2000;
    ahead.is_backward = random() % 2 == 0;
    const std::size_t place = random() % group.size(), step = place / pages;
    const PageEntry& wanted = group[place];
    if (wanted.size == 0 || in_memory.has(wanted.offset, wanted.size)) continue;
    const std::uint64_t most = std::max<std::uint64_t>(wanted.size, ahead.length(wanted.offset));
    const std::size_t coded_with = random() % (step + 1);
    const FileStretch read = stretch_to_read(group, place, coded_with, ahead, in_memory, 1 << 20);
    ASSERT_LE(read.begin, wanted.offset);
    ASSERT_GE(read.end, wanted.offset + wanted.size);
    if (pages > 1) {
      ASSERT_LE(read.end - read.begin, most);
    }
    for (const PageEntry& entry : entries) {
      const std::uint64_t end = entry.offset + entry.size;
      if (entry.size == 0 || end <= read.begin || entry.offset >= read.end) continue;
      ASSERT_TRUE(entry.offset >= read.begin && end <= read.end) << "a part of a page";
      ASSERT_FALSE(in_memory.has(entry.offset, entry.size)) << "a page that is known";
    }
    if (pages > 1 || coded_with == 0) continue;
    // The read has all pages that this one is coded with, up to the first one in memory.
    for (std::size_t n = 1; n <= coded_with; ++n) {
      const PageEntry& before = group[place - n];
      if (before.size == 0) continue;
      if (in_memory.has(before.offset, before.size)) break;
      ASSERT_LE(read.begin, before.offset);
    }
  }
}

/// Each byte of a page is read once, whatever the layout of pages and the order of reads.
TEST(PageGroups, NoByteIsReadTwiceWhereMemoryIsEnough) {
  const test::Scratch folder;
  const TestSeries<std::uint8_t> series({38, 36, 34}, Motion::kWaves, 20);
  std::mt19937 random(9);
  for (const std::uint32_t group : {1u, 8u, 512u}) {
    build_series(folder / "a.adm", "a.adm", series.source(), in_groups(group, 10));
    for (const std::uint64_t bytes : {300u, 5000u, 100'000u}) {
      for (const int order : {0, 1, 2}) {
        SCOPED_TRACE(testing::Message() << group << " pages, reads of " << bytes << ", order " << order);
        StoreFile file(folder / "a.adm"), alone(folder / "a.adm");
        ReadAhead ahead;
        ahead.bytes = bytes;
        ahead.is_backward = order == 1;
        ahead.memory = 1 << 26;
        set_read_ahead(file, ahead);
        std::vector<std::uint32_t> steps(20);
        for (std::uint32_t n = 0; n < 20; ++n) steps[n] = order == 1 ? 19 - n : n;
        if (order == 2) std::ranges::shuffle(steps, random);
        for (const std::uint32_t step : steps) {
          for (const PageId& id : pages_of(file.grid())) {
            if (random() % 4 == 0) continue;
            const auto wanted = alone.read(step, id), found = file.read(step, id);
            ASSERT_EQ(found.state, PageState::kWhole);
            ASSERT_TRUE(std::ranges::equal(found.bytes, wanted.bytes));
          }
        }
        EXPECT_LE(file.bytes_read(), file.size());
        EXPECT_LT(file.page_reads(), alone.page_reads());
      }
    }
  }
}

}  // namespace
}  // namespace adamas
