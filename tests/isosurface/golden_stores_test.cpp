#include "tests/support/golden_stores.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>

#include "isosurface/storage/stored_pages.h"
#include "tests/support/prepared_volume.h"
#include "tests/support/short_vectors.h"
#include "timevarying/verify_store.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

using test::GoldenStore;

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Calls f(store, volume) for each golden store.
template <class F>
void for_each_store(F f) {
  for (const GoldenStore& store : test::golden_stores()) {
    SCOPED_TRACE(store.name);
    with_sample_type(store.type,
                     [&](auto sample) { f(store, test::golden_volume<decltype(sample)>(store)); });
    if (testing::Test::HasFatalFailure()) return;
  }
}

/// The ends of a range as they are stored: multiples of 2^bits, rounded outwards, but not beyond the range of
/// the whole volume. The number of bits is in the first five bits of the tables.
template <class Word>
struct StoredRange {
  int bits;
  Word volume_low = std::numeric_limits<Word>::max(), volume_high = 0;

  [[nodiscard]] Word low(Word low, Word high) const {
    return low > high ? low : std::max(volume_low, static_cast<Word>(low - low % (Word{1} << bits)));
  }
  [[nodiscard]] Word high(Word low, Word high) const {
    const Word past = (Word{1} << bits) - 1;
    return low > high ? high : std::min(volume_high, static_cast<Word>(high | past));
  }
};

/// Expects that the samples are those of the volume, and the bounds those that preprocessing finds, with
/// rounded ranges.
template <class Sample>
void expect_contents(const GoldenStore& store, const test::MemoryVolume<Sample>& volume) {
  using Word = OrderedWord<Sample>;
  StoreFile file(store.path());
  ASSERT_EQ(verify_store(file, 0, SilentProgress::instance()).bad_pages, 0u);
  ASSERT_EQ(test::restored<Sample>(file), test::bits_of(volume.samples));
  const test::PreparedVolume<Sample> prepared(store.dimensions, volume.samples, store.spacing,
                                              NoiseBounds::kSame);
  StoredPages<Word> pages(file, 0, std::size_t{1} << 24);
  StoredRange<Word> stored{std::to_integer<int>(file.header().bounds_tables[0]) & 31};
  const PageId coarsest{file.grid().top(), {0, 0, 0}};
  const Page<Word> all = prepared.page(coarsest);
  for_each_own_place(prepared.shape(coarsest), [&](std::size_t at) {
    if (all.low[at] > all.high[at]) return;
    stored.volume_low = std::min(stored.volume_low, all.low[at]);
    stored.volume_high = std::max(stored.volume_high, all.high[at]);
  });
  const std::uint64_t end = std::uint64_t{2} << (3 * file.grid().top());
  for (std::uint64_t number = 1; number < end; ++number) {
    const PageId id = file.grid().page(number);
    if (!file.grid().contains(id)) continue;
    Page<Word> found{};
    ASSERT_TRUE(pages.copy(id, found)) << page_name(id);
    const Page<Word> page = prepared.page(id);
    for_each_own_place(prepared.shape(id), [&](std::size_t at) {
      ASSERT_EQ(found.samples[at], page.samples[at]) << page_name(id) << " place " << at;
      const Word low = page.low[at], high = page.high[at];
      ASSERT_EQ(found.low[at], stored.low(low, high)) << page_name(id) << " place " << at;
      ASSERT_EQ(found.high[at], stored.high(low, high)) << page_name(id) << " place " << at;
      ASSERT_EQ(found.errors[at], page.errors[at]) << page_name(id) << " place " << at;
    });
  }
}

TEST(GoldenStores, HoldTheirVolumes) {
  for_each_store([](const auto& store, const auto& volume) { expect_contents(store, volume); });
}

TEST(GoldenStores, AreReadAlikeWithShortVectors) {
  const test::ShortVectors scope;
  for_each_store([](const auto& store, const auto& volume) { expect_contents(store, volume); });
}

/// Makes the files anew where ADAMAS_WRITE_GOLDEN is set.
TEST(GoldenStores, AreBuiltAlike) {
  const bool is_new = std::getenv("ADAMAS_WRITE_GOLDEN") != nullptr;
  for_each_store([&](const auto& store, const auto& volume) {
    const test::Scratch folder;
    const auto path = is_new ? store.path() : folder / "a.adm";
    test::build(path, volume, store.options);
    ASSERT_TRUE(bytes_of(path) == bytes_of(store.path()));
  });
}

TEST(GoldenStores, AreBuiltAlikeWithShortVectors) {
  const test::ShortVectors scope;
  for_each_store([&](const auto& store, const auto& volume) {
    const test::Scratch folder;
    test::build(folder / "a.adm", volume, store.options);
    ASSERT_TRUE(bytes_of(folder / "a.adm") == bytes_of(store.path()));
  });
}

}  // namespace
}  // namespace adamas
