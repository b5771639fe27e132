#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include "core/base/error.h"
#include "isosurface/compression/page_order.h"
#include "isosurface/compression/ranks/ranked_codec.h"
#include "isosurface/compression/sample_codec.h"

namespace adamas {

using namespace isosurface;

namespace {

using Values = std::vector<std::uint32_t>;

/// Returns sets of values that lie close together, far apart, in clumps, and at the ends of the range.
std::vector<Values> some_values() {
  std::vector<Values> all{{0}, {5}, {0xffffffff}, {0, 0xffffffff}, {0x80000000, 0x80000001}};
  std::mt19937 random(3);
  for (const int shift : {0, 8, 16, 24}) {
    std::set<std::uint32_t> values;
    for (int n = 0; n < 3000; ++n) values.insert(static_cast<std::uint32_t>(random()) >> shift);
    all.emplace_back(values.begin(), values.end());
    for (int n = 0; n < 500; ++n) values.insert(0xfffff000u + static_cast<std::uint32_t>(random()) % 4096);
    all.emplace_back(values.begin(), values.end());
  }
  Values most(SampleRanks::kMost);
  for (std::size_t n = 0; n < most.size(); ++n) most[n] = static_cast<std::uint32_t>(n * 3);
  all.push_back(most);
  return all;
}

std::uint32_t rank_by_search(const Values& values, std::uint32_t value) {
  const auto found = std::lower_bound(values.begin(), values.end(), value);
  if (found == values.end() || *found != value) return SampleRanks::kNone;
  return static_cast<std::uint32_t>(found - values.begin());
}

TEST(SampleRanks, FindsWhatASearchFinds) {
  std::mt19937 random(4);
  for (const Values& values : some_values()) {
    const SampleRanks ranks(values);
    Values asked = values;
    for (const std::uint32_t value : values) asked.insert(asked.end(), {value - 1, value + 1});
    for (int n = 0; n < 1000; ++n) asked.push_back(static_cast<std::uint32_t>(random()));
    Values known(values.size()), found(asked.size());
    ranks.ranks(std::span<const std::uint32_t>(values), known.data());
    for (std::size_t n = 0; n < values.size(); ++n) ASSERT_EQ(known[n], n);
    ranks.ranks(std::span<const std::uint32_t>(asked), found.data());
    for (std::size_t n = 0; n < asked.size(); ++n) {
      const std::uint32_t expected = rank_by_search(values, asked[n]);
      ASSERT_EQ(ranks.rank(asked[n]), expected) << asked[n];
      ASSERT_EQ(found[n], expected) << asked[n];
    }
  }
}

TEST(SampleRanks, ComeBackFromBytes) {
  for (const Values& values : some_values()) {
    const std::vector<std::byte> bytes = SampleRanks(values).write();
    const SampleRanks read = SampleRanks::read(bytes, 32, "here");
    EXPECT_TRUE(std::ranges::equal(read.values(), values));
    EXPECT_EQ(read.write(), bytes);
    if (values.back() > 0xffff) {
      EXPECT_THROW(static_cast<void>(SampleRanks::read(bytes, 16, "here")), Error);
    }
  }
}

TEST(SampleRanks, RefuseBytesThatAreCutTooLongOrFlipped) {
  std::mt19937 random(5);
  const std::vector<Values> all = some_values();
  for (std::size_t n = 0; n + 1 < all.size(); ++n) {
    std::vector<std::byte> bytes = SampleRanks(all[n]).write();
    for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 50)
      EXPECT_THROW(static_cast<void>(SampleRanks::read(std::span(bytes).first(length), 32, "here")), Error);
    for (int trial = 0; trial < 50; ++trial) {
      std::vector<std::byte> flipped = bytes;
      flipped[random() % bytes.size()] ^= static_cast<std::byte>(1u << random() % 8);
      try {
        EXPECT_EQ(SampleRanks::read(flipped, 32, "here").write(), flipped);
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).rfind("here: ", 0), 0u) << error.what();
      }
    }
    bytes.push_back(std::byte{0});
    EXPECT_THROW(static_cast<void>(SampleRanks::read(bytes, 32, "here")), Error);
  }
}

template <class Word>
std::shared_ptr<const SampleRanks> census(const PageShape& shape, const std::vector<Word>& own, Word other) {
  const auto samples = std::make_unique<PagePoints<Word>>();
  samples->fill(other);
  std::size_t next = 0;
  for_each_own_point(shape, [&](LatticePoint q, std::uint64_t) {
    (*samples)[PageGrid::place(q, 0)] = own[next++ % own.size()];
  });
  SampleCensus<Word> result;
  result.add(shape, *samples);
  return result.ranks();
}

TEST(SampleCensus, TellsTheValuesOfAPagesOwnPoints) {
  for (const PageShape& shape : {PageShape{{16, 16, 16}, false, 0}, PageShape{{16, 16, 16}, true, 2},
                                 PageShape{{9, 12, 16}, false, 1}, PageShape{{1, 16, 16}, false, 0}}) {
    const auto found = census<std::uint16_t>(shape, {7, 65535, 0, 7, 400}, 9);
    ASSERT_NE(found, nullptr);
    EXPECT_TRUE(std::ranges::equal(found->values(), Values{0, 7, 400, 65535}));
    const auto floats = census<std::uint32_t>(shape, {0xffffffff, 0}, 9);
    ASSERT_NE(floats, nullptr);
    EXPECT_TRUE(std::ranges::equal(floats->values(), Values{0, 0xffffffff}));
    EXPECT_EQ(census<std::uint8_t>(shape, {1, 2}, 9), nullptr);
  }
}

TEST(SampleCensus, GivesNothingWhereRanksDoNotPay) {
  std::vector<std::uint16_t> many(200);
  for (std::size_t n = 0; n < many.size(); ++n) many[n] = static_cast<std::uint16_t>(n);
  EXPECT_EQ(census<std::uint16_t>({{16, 16, 16}, true, 2}, many, 0), nullptr);
  SampleCensus<std::uint16_t> words;
  EXPECT_EQ(words.ranks(), nullptr);
  // There are so many pages that only the number of values decides: 4095 values are ranked, 4096 are not.
  const PageShape shape{{16, 16, 16}, true, 2};
  PagePoints<std::uint16_t> page;
  for (std::size_t n = 0; n < page.size(); ++n) page[n] = static_cast<std::uint16_t>(n % 4095);
  for (int n = 0; n < 40; ++n) words.add(shape, page);
  ASSERT_NE(words.ranks(), nullptr);
  EXPECT_EQ(words.ranks()->values().size(), 4095u);
  page[0] = 5000;
  words.add(shape, page);
  EXPECT_EQ(words.ranks(), nullptr);
  words.add(shape, page);
  EXPECT_EQ(words.ranks(), nullptr);
}

TEST(SampleRanks, AreNotOfBytes) {
  const auto tables = sample_survey<std::uint8_t>(SampleCoding::kInterpolation)->codec()->tables();
  EXPECT_THROW(static_cast<void>(parse_sample_codec<std::uint8_t>(SampleCoding::kRanks, tables, "here")),
               Error);
}

}  // namespace
}  // namespace adamas
