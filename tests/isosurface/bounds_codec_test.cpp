#include "isosurface/compression/bounds/bounds_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "core/base/error.h"
#include "datasets/buckyball.h"
#include "isosurface/volume/samples.h"
#include "tests/isosurface/bounds_codec_checks.h"

namespace adamas {

using namespace datasets;
using namespace isosurface;

namespace {

using test::any_case, test::Bytes, test::Case, test::Cases, test::cases_of, test::codec_of, test::encoded,
    test::expect_all_there_and_back, test::expect_there_and_back, test::kDimensions, test::kEven,
    test::PreparedVolume, test::samples_of, test::waves;

template <class Word>
class BoundsCodecOf : public testing::Test {};
using Words = testing::Types<std::uint8_t, std::uint16_t, std::uint32_t>;
TYPED_TEST_SUITE(BoundsCodecOf, Words);

template <class Sample>
void expect_less_than(double bits, double scale, Vec3 spacing = {1, 1, 1}) {
  const PreparedVolume<Sample> reference(kDimensions, waves<Sample>(kDimensions, scale), spacing);
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
  const PreparedVolume<std::uint16_t> reference(kDimensions, std::vector<std::uint16_t>(41 * 35 * 30, 9));
  const auto cases = cases_of(reference);
  const auto codec = codec_of(cases);
  for (const auto& c : cases) {
    expect_there_and_back(codec, c);
    // The coarsest page has a point at which no diamond is split, so it may take more.
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
  expect_all_there_and_back(cases_of(PreparedVolume<float>(kDimensions, samples)));
}

TEST(BoundsCodec, CodesOneVolumeWithTheTablesOfAnother) {
  const auto cases =
      cases_of(PreparedVolume<std::uint8_t>(kDimensions, waves<std::uint8_t>(kDimensions, 100)));
  const Buckyball ball({33, 33, 33}, SampleType::kUint8);
  std::vector<std::uint8_t> samples(33 * 33 * 33);
  for (std::uint64_t k = 0; k < 33; ++k) {
    ball.plane(k, std::as_writable_bytes(std::span(samples)).subspan(33 * 33 * k, 33 * 33));
  }
  const auto others = cases_of(PreparedVolume<std::uint8_t>({33, 33, 33}, samples));
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
  // A codec that has seen no page brings them back too.
  const auto codec = codec_of<TypeParam>({});
  for (const auto& c : cases) expect_there_and_back(codec, c);
}

/// Rounds the ranges of pages to this many bits, as a store does, and returns the rounding. Empty ranges of a
/// page all become the same one.
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

/// Expects that a volume takes fewer bytes with rounded ranges.
template <class Sample>
void expect_fewer_bytes(const std::vector<Sample>& samples, int bits) {
  auto cases = cases_of(PreparedVolume<Sample>(kDimensions, samples));
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

/// A page of equal ranges takes two bytes, one for the modes and one for the error, and two words. Where one
/// error differs, the others are coded with it. Bytes that are not rounded, or that would be coded in another
/// way, are refused.
TYPED_TEST(BoundsCodecOf, CodesEqualRangesInTwoWords) {
  constexpr std::size_t kBytes = 2 + 2 * sizeof(TypeParam);
  std::mt19937_64 random(14);
  Cases<TypeParam> cases;
  for (const PageShape& shape :
       {PageShape{{16, 16, 16}, false, 0}, PageShape{{7, 16, 3}, false, 2}, PageShape{{9, 9, 9}, true, 2}}) {
    Case<TypeParam> c = any_case<TypeParam>(random, shape);
    c.page.low.fill(32);
    c.page.high.fill(127);
    c.page.errors.fill(63);
    cases.push_back(c);
  }
  EXPECT_EQ(expect_all_there_and_back(cases), 3 * kBytes);
  const RangeRounding<TypeParam> rounding{4, {16, 64}};
  EXPECT_EQ(expect_all_there_and_back(cases, kEven, rounding), 3 * kBytes);
  for (Case<TypeParam>& c : cases) {
    const auto codec = codec_of<TypeParam>({c}, kEven, rounding);
    const auto page = samples_of(c);
    for (std::size_t at = 0; at < kBytes; ++at) {
      // Words have the same rule for all values of a byte; this step takes all values of its lower half.
      for (unsigned byte = 0; byte < 256; byte += at < 2 ? 1 : 17) {
        Bytes corrupt = encoded(codec, c);
        corrupt[at] = static_cast<std::byte>(byte);
        if (!codec.decode(corrupt, c.shape, c.around, *page, *page)) continue;
        ASSERT_EQ(encoded(codec, {c.shape, c.around, *page}), corrupt) << at;
      }
    }
    c.page.errors[PageGrid::place({1, 0, 0}, 0)] = 62;
  }
  EXPECT_GT(expect_all_there_and_back(cases), 3 * kBytes);
}

TEST(BoundsCodec, IsTheSameForSurveysInAnyOrder) {
  const auto cases =
      cases_of(PreparedVolume<std::uint8_t>(kDimensions, waves<std::uint8_t>(kDimensions, 100)));
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
  const Case<TypeParam> c = any_case<TypeParam>(random, {{5, 4, 3}, false, 0});
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
      cases_of(PreparedVolume<std::uint8_t>({20, 20, 20}, waves<std::uint8_t>({20, 20, 20}, 100)));
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
