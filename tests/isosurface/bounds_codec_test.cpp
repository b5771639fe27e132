#include "isosurface/compression/bounds_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "core/base/error.h"
#include "datasets/buckyball.h"
#include "isosurface/volume/samples.h"
#include "tests/support/prepared_volume.h"

namespace adamas {
namespace {

using Bytes = std::vector<std::byte>;

constexpr Vec3 kEven{1, 1, 1};

template <class Word>
struct Case {
  PageShape shape{};
  Surroundings<Word> around{};
  Page<Word> page{};
};
template <class Word>
using Cases = std::vector<Case<Word>>;

template <class Word>
BoundsCodec<Word> codec_of(const Cases<Word>& cases, const Vec3& spacing = kEven,
                           const RangeRounding<Word>& rounding = {}) {
  BoundsSurvey<Word> survey(spacing, rounding);
  for (const auto& c : cases) survey.add(c.shape, c.around, c.page);
  return BoundsCodec<Word>(survey);
}

template <class Word>
Bytes encoded(const BoundsCodec<Word>& codec, const Case<Word>& c) {
  Bytes bytes;
  codec.encode(c.shape, c.around, c.page, bytes);
  return bytes;
}

/// A page of which nothing but the samples is known.
template <class Word>
std::unique_ptr<Page<Word>> samples_of(const Case<Word>& c) {
  auto page = std::make_unique<Page<Word>>();
  page->samples = c.page.samples;
  page->low.fill(77);
  page->high.fill(33);
  page->errors.fill(5);
  return page;
}

template <class Word>
void expect_there_and_back(const BoundsCodec<Word>& codec, const Case<Word>& c) {
  const Bytes bytes = encoded(codec, c);
  const auto found = samples_of(c);
  ASSERT_TRUE(codec.decode(bytes, c.shape, c.around, *found, *found));
  for (LatticePoint q{0, 0, 0}; q.k < c.shape.count.k; ++q.k) {
    for (q.j = 0; q.j < c.shape.count.j; ++q.j) {
      for (q.i = 0; q.i < c.shape.count.i; ++q.i) {
        const std::size_t place = PageGrid::place(q, 0), from = surrounding_place(q);
        const bool own = c.shape.owns(q);
        ASSERT_EQ(found->errors[place], own ? c.page.errors[place] : c.around.errors[from]);
        ASSERT_EQ(found->low[place], own ? c.page.low[place] : c.around.low[from]);
        ASSERT_EQ(found->high[place], own ? c.page.high[place] : c.around.high[from]);
      }
    }
  }
}

/// With the codec of all, and with that which is made from its tables. Returns the bytes of all pages.
template <class Word>
std::size_t expect_all_there_and_back(const Cases<Word>& cases, const Vec3& spacing = kEven,
                                      const RangeRounding<Word>& rounding = {}) {
  const BoundsCodec<Word> codec = codec_of(cases, spacing, rounding);
  const BoundsCodec<Word> parsed = BoundsCodec<Word>::parse(codec.tables(), spacing, "here");
  EXPECT_EQ(parsed.tables(), codec.tables());
  std::size_t size = 0;
  for (const auto& c : cases) {
    expect_there_and_back(codec, c);
    EXPECT_EQ(encoded(parsed, c), encoded(codec, c));
    size += encoded(codec, c).size();
  }
  return size;
}

template <class Sample>
Cases<OrderedWord<Sample>> cases_of(const test::PreparedVolume<Sample>& reference) {
  Cases<OrderedWord<Sample>> cases;
  const PageGrid& grid = reference.grid();
  for (std::uint64_t number = 1; cases.size() < grid.page_count(); ++number) {
    const PageId id = grid.page(number);
    if (!grid.contains(id)) continue;
    cases.push_back({reference.shape(id), {}, reference.page(id)});
    if (!cases.back().shape.complete) cases.back().around = reference.around(id);
  }
  return cases;
}

template <class Sample>
std::vector<Sample> waves(std::array<std::uint64_t, 3> n, double scale) {
  std::vector<Sample> samples;
  for (std::uint64_t k = 0; k < n[2]; ++k) {
    for (std::uint64_t j = 0; j < n[1]; ++j) {
      for (std::uint64_t i = 0; i < n[0]; ++i) {
        const auto x = static_cast<double>(i), y = static_cast<double>(j), z = static_cast<double>(k);
        samples.push_back(static_cast<Sample>(scale * (1 + std::sin(0.3 * x) * std::cos(0.2 * y + 0.1 * z))));
      }
    }
  }
  return samples;
}

constexpr std::array<std::uint64_t, 3> kDimensions{41, 35, 30};

template <class Word>
Word any_word(std::mt19937_64& random) {
  // Often alike, often extremes.
  const std::uint64_t word = random();
  if (word % 4 == 0) return static_cast<Word>(word >> 62);
  if (word % 4 == 1) return static_cast<Word>(~(word >> 62));
  return static_cast<Word>(word >> 20);
}

template <class Word>
Case<Word> any_case(std::mt19937_64& random, const PageShape& shape) {
  Case<Word> c{shape, {}, {}};
  const auto fill = [&random](auto& words) {
    for (auto& word : words) word = any_word<std::remove_reference_t<decltype(word)>>(random);
  };
  const auto fill_codes = [&random](auto& codes) {
    for (auto& code : codes) code = static_cast<std::uint8_t>(random() & 63);
  };
  fill(c.around.samples), fill(c.around.low), fill(c.around.high), fill_codes(c.around.errors);
  fill(c.page.samples), fill(c.page.low), fill(c.page.high), fill_codes(c.page.errors);
  return c;
}

template <class Word>
class BoundsCodecOf : public testing::Test {};
using Words = testing::Types<std::uint8_t, std::uint16_t, std::uint32_t>;
TYPED_TEST_SUITE(BoundsCodecOf, Words);

template <class Sample>
void expect_less_than(double bits, double scale, Vec3 spacing = {1, 1, 1}) {
  const test::PreparedVolume<Sample> reference(kDimensions, waves<Sample>(kDimensions, scale), spacing);
  const auto cases = cases_of(reference);
  const std::size_t size = expect_all_there_and_back(cases, spacing);
  const auto points = static_cast<double>(kDimensions[0] * kDimensions[1] * kDimensions[2]);
  EXPECT_LT(8 * static_cast<double>(size) / points, bits);
}

TEST(BoundsCodec, CodesWhatVolumesHold) {
  expect_less_than<std::uint8_t>(3, 120);
  expect_less_than<std::uint16_t>(6, 30000);
  expect_less_than<std::int16_t>(6, 15000);
  expect_less_than<float>(12, 1);
  expect_less_than<std::uint8_t>(4, 120, {1, 1, 2.5});
}

TYPED_TEST(BoundsCodecOf, KnowsNothingOfValuesBeforeAndFarBehindThePage) {
  using Word = TypeParam;
  std::mt19937_64 random(9);
  for (const LatticePoint count : {LatticePoint{16, 16, 16}, LatticePoint{16, 9, 1}}) {
    for (const int lod : {0, 1}) {
      Case<Word> c = any_case<Word>(random, {count, false, lod});
      const BoundsCodec<Word> codec = codec_of<Word>({c});
      const Bytes expected = encoded(codec, c);
      const Case<Word> other = any_case<Word>(random, c.shape);
      for (std::size_t n = 0; n < Surroundings<Word>::kPoints; ++n) {
        if (n % 11 % 10 != 0 && n / 11 % 11 % 10 != 0 && n / 121 % 10 != 0) continue;
        c.around.low[n] = other.around.low[n];
        c.around.high[n] = other.around.high[n];
        c.around.errors[n] = other.around.errors[n];
      }
      ASSERT_EQ(codec_of<Word>({c}).tables(), codec.tables());
      ASSERT_EQ(encoded(codec, c), expected);
      expect_there_and_back(codec, c);
    }
  }
}

TEST(BoundsCodec, CodesAConstantInAByte) {
  const test::PreparedVolume<std::uint16_t> reference(kDimensions,
                                                      std::vector<std::uint16_t>(41 * 35 * 30, 9));
  const auto cases = cases_of(reference);
  const auto codec = codec_of(cases);
  for (const auto& c : cases) {
    expect_there_and_back(codec, c);
    // The coarsest page has a point that no diamond is split at.
    if (!c.shape.complete) {
      EXPECT_EQ(encoded(codec, c).size(), 1u);
    }
  }
}

TEST(BoundsCodec, CodesWhereNumbersAreNotFinite) {
  std::vector<float> samples = waves<float>(kDimensions, 3);
  std::mt19937_64 random(1);
  const float infinity = std::numeric_limits<float>::infinity();
  for (int n = 0; n < 300; ++n) {
    const float special[] = {infinity, -infinity, std::nanf(""), -std::nanf(""),
                             -0.0f,    3e38f,     -3e38f,        1e-42f};
    samples[random() % samples.size()] = special[random() % 8];
  }
  expect_all_there_and_back(cases_of(test::PreparedVolume<float>(kDimensions, samples)));
}

TEST(BoundsCodec, CodesOneVolumeWithTheTablesOfAnother) {
  const auto cases =
      cases_of(test::PreparedVolume<std::uint8_t>(kDimensions, waves<std::uint8_t>(kDimensions, 100)));
  const Buckyball ball({33, 33, 33}, SampleType::kUint8);
  std::vector<std::uint8_t> samples(33 * 33 * 33);
  for (std::uint64_t k = 0; k < 33; ++k) {
    ball.plane(k, std::as_writable_bytes(std::span(samples)).subspan(33 * 33 * k, 33 * 33));
  }
  const auto others = cases_of(test::PreparedVolume<std::uint8_t>({33, 33, 33}, samples));
  const auto codec = codec_of(cases);
  for (const auto& c : others) expect_there_and_back(codec, c);
}

TYPED_TEST(BoundsCodecOf, CodesAnything) {
  std::mt19937_64 random(2);
  Cases<TypeParam> cases;
  for (const int lod : {0, 1, 5}) cases.push_back(any_case<TypeParam>(random, {{16, 16, 16}, false, lod}));
  cases.push_back(any_case<TypeParam>(random, {{9, 9, 9}, true, 4}));
  cases.push_back(any_case<TypeParam>(random, {{16, 16, 16}, true, 4}));
  expect_all_there_and_back(cases);
  // And with a codec that has seen nothing.
  const auto codec = codec_of<TypeParam>({});
  for (const auto& c : cases) expect_there_and_back(codec, c);
}

/// The ranges of pages, and round them, as a store has them: rounded to this many bits. Those that are not of
/// any sample are all the same.
template <class Word>
RangeRounding<Word> round_all(Cases<Word>& cases, int bits) {
  constexpr Word kMost = std::numeric_limits<Word>::max();
  RangeRounding<Word> rounding{bits, {kMost, kMost}};
  for (auto& c : cases) {
    for (std::size_t n = 0; n < c.page.low.size(); ++n) {
      if (c.page.low[n] > c.page.high[n]) c.page.low[n] = kMost, c.page.high[n] = 0;
      const std::size_t around = n % Surroundings<Word>::kPoints;
      if (c.around.low[around] > c.around.high[around])
        std::swap(c.around.low[around], c.around.high[around]);
      rounding.least[0] = std::min({rounding.least[0], c.page.low[n], c.around.low[around]});
      rounding.least[1] = std::min(
          {rounding.least[1], static_cast<Word>(~c.page.high[n]), static_cast<Word>(~c.around.high[around])});
    }
  }
  for (auto& c : cases) {
    rounding.round(c.page.low, c.page.high);
    rounding.round(c.around.low, c.around.high);
  }
  return rounding;
}

TYPED_TEST(BoundsCodecOf, CodesRoundedRanges) {
  std::mt19937_64 random(12);
  for (int bits = 1; bits <= RangeRounding<TypeParam>::kMostBits; bits += sizeof(TypeParam) == 1 ? 1 : 5) {
    Cases<TypeParam> cases;
    for (const int lod : {0, 1, 5}) cases.push_back(any_case<TypeParam>(random, {{16, 16, 16}, false, lod}));
    cases.push_back(any_case<TypeParam>(random, {{5, 16, 8}, false, 0}));
    cases.push_back(any_case<TypeParam>(random, {{9, 9, 9}, true, 4}));
    const RangeRounding<TypeParam> rounding = round_all(cases, bits);
    expect_all_there_and_back(cases, kEven, rounding);
  }
}

/// With rounded ranges a volume takes fewer bytes.
template <class Sample>
void expect_fewer_bytes(const std::vector<Sample>& samples, int bits) {
  auto cases = cases_of(test::PreparedVolume<Sample>(kDimensions, samples));
  const std::size_t exact = expect_all_there_and_back(cases);
  const auto rounding = round_all(cases, bits);
  EXPECT_LT(expect_all_there_and_back(cases, kEven, rounding), exact);
}

TEST(BoundsCodec, RoundedRangesTakeFewerBytes) {
  expect_fewer_bytes(waves<std::uint8_t>(kDimensions, 120), 4);
  expect_fewer_bytes(waves<std::uint16_t>(kDimensions, 30000), 11);
  expect_fewer_bytes(waves<std::int16_t>(kDimensions, 15000), 11);
  std::vector<float> samples = waves<float>(kDimensions, 1);
  for (std::size_t n = 0; n < samples.size(); n += 997) samples[n] = std::nanf("");
  expect_fewer_bytes(samples, 20);
}

TYPED_TEST(BoundsCodecOf, CodesPagesOfAllSizes) {
  std::mt19937_64 random(3);
  Cases<TypeParam> cases;
  for (int n = 1; n <= 16; ++n) {
    const auto any = [&random] { return 1 + static_cast<std::int32_t>(random() % 16); };
    cases.push_back(any_case<TypeParam>(random, {{n, any(), any()}, false, 0}));
    cases.push_back(any_case<TypeParam>(random, {{any(), n, any()}, false, 1}));
    cases.push_back(any_case<TypeParam>(random, {{any(), any(), n}, n % 2 == 0, 0}));
  }
  expect_all_there_and_back(cases);
}

TYPED_TEST(BoundsCodecOf, CodesPagesThatAreAllAlike) {
  std::mt19937_64 random(4);
  Cases<TypeParam> cases;
  for (const PageShape& shape :
       {PageShape{{16, 16, 16}, false, 0}, PageShape{{7, 16, 3}, false, 2}, PageShape{{9, 9, 9}, true, 2}}) {
    Case<TypeParam> c = any_case<TypeParam>(random, shape);
    c.page.low.fill(std::numeric_limits<TypeParam>::max());
    c.page.high.fill(0);
    c.page.errors.fill(63);
    cases.push_back(c);
  }
  EXPECT_EQ(expect_all_there_and_back(cases), 6u);
}

TEST(BoundsCodec, IsTheSameForSurveysInAnyOrder) {
  const auto cases =
      cases_of(test::PreparedVolume<std::uint8_t>(kDimensions, waves<std::uint8_t>(kDimensions, 100)));
  BoundsSurvey<std::uint8_t> forth(kEven), back(kEven), parts(kEven);
  for (std::size_t n = 0; n < cases.size(); ++n) {
    const auto& a = cases[n];
    const auto& b = cases[cases.size() - 1 - n];
    forth.add(a.shape, a.around, a.page);
    back.add(b.shape, b.around, b.page);
    BoundsSurvey<std::uint8_t> one(kEven);
    one.add(a.shape, a.around, a.page);
    parts.merge(one);
  }
  const Bytes tables = BoundsCodec<std::uint8_t>(forth).tables();
  EXPECT_EQ(BoundsCodec<std::uint8_t>(back).tables(), tables);
  EXPECT_EQ(BoundsCodec<std::uint8_t>(parts).tables(), tables);
}

TYPED_TEST(BoundsCodecOf, RefusesPagesThatAreCutOrTooLong) {
  std::mt19937_64 random(5);
  const Case<TypeParam> c = any_case<TypeParam>(random, {{8, 5, 6}, false, 0});
  const auto codec = codec_of<TypeParam>({c});
  Bytes bytes = encoded(codec, c);
  const auto page = samples_of(c);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    ASSERT_FALSE(codec.decode(std::span(bytes).first(length), c.shape, c.around, *page, *page)) << length;
  }
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(codec.decode(bytes, c.shape, c.around, *page, *page));
}

TYPED_TEST(BoundsCodecOf, AnswersToFlippedBits) {
  std::mt19937_64 random(6);
  const Case<TypeParam> c = any_case<TypeParam>(random, {{6, 7, 5}, false, 0});
  const auto codec = codec_of<TypeParam>({c});
  const Bytes bytes = encoded(codec, c);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    Bytes corrupt = bytes;
    corrupt[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
    auto page = samples_of(c);
    if (!codec.decode(corrupt, c.shape, c.around, *page, *page)) continue;
    const auto other = std::make_unique<Case<TypeParam>>(Case<TypeParam>{c.shape, c.around, *page});
    ASSERT_EQ(encoded(codec, *other), corrupt) << bit;
  }
}

TEST(BoundsCodec, AnswersToTablesThatAreCutOrCorrupt) {
  const auto cases =
      cases_of(test::PreparedVolume<std::uint8_t>({20, 20, 20}, waves<std::uint8_t>({20, 20, 20}, 100)));
  const auto codec = codec_of(cases);
  const Bytes tables = codec.tables();
  for (std::size_t length = 0; length < tables.size(); ++length) {
    EXPECT_THROW(
        static_cast<void>(BoundsCodec<std::uint8_t>::parse(std::span(tables).first(length), kEven, "here")),
        Error);
  }
  Bytes longer = tables;
  longer.push_back(std::byte{0});
  EXPECT_THROW(static_cast<void>(BoundsCodec<std::uint8_t>::parse(longer, kEven, "here")), Error);
  std::size_t good = 0;
  for (std::size_t bit = 0; bit < 8 * tables.size(); ++bit) {
    Bytes corrupt = tables;
    corrupt[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
    try {
      const auto other = BoundsCodec<std::uint8_t>::parse(corrupt, kEven, "here");
      ASSERT_EQ(other.tables(), corrupt);
      if (++good % 50 == 0) expect_there_and_back(other, cases.back());
    } catch (const Error& error) {
      ASSERT_EQ(std::string(error.what()).rfind("here: ", 0), 0u) << error.what();
    }
  }
  EXPECT_GT(good, 0u);
}

}  // namespace
}  // namespace adamas
