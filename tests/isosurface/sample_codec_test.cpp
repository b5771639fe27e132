#include "isosurface/compression/sample_codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <set>

#include "core/base/error.h"
#include "isosurface/compression/ranks/ranked_codec.h"
#include "isosurface/volume/samples.h"
#include "tests/isosurface/sample_codec_checks.h"
#include "tests/support/volume_pages.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::Bytes, test::codec_of, test::codings, test::content_of, test::Dimensions, test::encoded,
    test::expect_there_and_back, test::random_samples, test::ranks_of, test::same_points, test::size_of,
    test::smooth_samples;
template <class Word>
using Content = test::PageContent<Word>;

template <class Word>
class SampleCodecOf : public testing::Test {};
using Words = testing::Types<std::uint8_t, std::uint16_t, std::uint32_t>;
TYPED_TEST_SUITE(SampleCodecOf, Words);

TYPED_TEST(SampleCodecOf, TakesVolumesOfAllShapes) {
  using Word = TypeParam;
  // Bytes are tested at all sizes, other words at some that differ in more than their numbers.
  const std::uint64_t step = sizeof(Word) == 1 ? 1 : 4;
  for (const SampleCoding coding : codings<Word>()) {
    for (std::uint64_t i = 1; i <= 9; i += step)
      for (std::uint64_t j = 1; j <= 9; j += step)
        for (std::uint64_t k = 1; k <= 9; k += step) {
          const Dimensions dimensions{i, j, k};
          const auto samples = (i + j + k) % 2 == 0
                                   ? random_samples<Word>(size_of(dimensions), i + 10 * j + 100 * k)
                                   : smooth_samples<Word>(dimensions);
          expect_there_and_back<Word>(coding, dimensions, samples);
        }
  }
}

TYPED_TEST(SampleCodecOf, TakesVolumesOfSeveralLods) {
  using Word = TypeParam;
  for (const SampleCoding coding : codings<Word>()) {
    for (const Dimensions& dimensions :
         {Dimensions{33, 33, 33}, {32, 31, 30}, {40, 17, 1}, {1, 1, 70}, {18, 35, 19}}) {
      expect_there_and_back<Word>(coding, dimensions, smooth_samples<Word>(dimensions, 0.02));
      expect_there_and_back<Word>(coding, dimensions, random_samples<Word>(size_of(dimensions), 3));
    }
  }
}

TYPED_TEST(SampleCodecOf, SpendsNextToNothingOnOneValue) {
  using Word = TypeParam;
  const Dimensions dimensions{49, 40, 33};
  for (const SampleCoding coding : codings<Word>()) {
    for (const Word value : {Word(0), Word(1), std::numeric_limits<Word>::max()}) {
      const test::VolumePages<Word> volume(dimensions, std::vector<Word>(size_of(dimensions), value));
      const std::size_t total =
          expect_there_and_back<Word>(coding, dimensions, std::vector<Word>(size_of(dimensions), value));
      // Only the first sample has a residual, since it is predicted as 0.
      EXPECT_LE(total, volume.pages().size() + 200);
    }
  }
}

TYPED_TEST(SampleCodecOf, TakesExtremes) {
  using Word = TypeParam;
  constexpr Word kMost = std::numeric_limits<Word>::max(), kHalf = kMost / 2 + 1;
  const Dimensions dimensions{34, 20, 18};
  for (const SampleCoding coding : codings<Word>()) {
    for (const std::array<Word, 2>& pair :
         {std::array<Word, 2>{0, kMost}, {0, kHalf}, {kMost, kHalf}, {Word(kHalf - 1), kHalf}, {0, 1}}) {
      std::vector<Word> samples(size_of(dimensions));
      for (std::size_t n = 0; n < samples.size(); ++n) samples[n] = pair[n % 2];
      expect_there_and_back<Word>(coding, dimensions, samples);
      for (std::size_t n = 0; n < samples.size(); ++n) samples[n] = pair[n % 3 == 0 ? 1 : 0];
      expect_there_and_back<Word>(coding, dimensions, samples);
    }
  }
}

TYPED_TEST(SampleCodecOf, TakesFibonacciCounts) {
  using Word = TypeParam;
  const Dimensions dimensions{33, 33, 33};
  std::mt19937_64 random(6);
  std::vector<Word> samples(size_of(dimensions));
  // Each value occurs 1.6 times as often as the next.
  for (Word& sample : samples) {
    int value = 0;
    while (random() % 1000 > 618) ++value;
    sample = static_cast<Word>(static_cast<std::uint32_t>(value * value) * 40503u);
  }
  for (const SampleCoding coding : codings<Word>()) expect_there_and_back<Word>(coding, dimensions, samples);
}

TYPED_TEST(SampleCodecOf, DoesNotExpandNoise) {
  using Word = TypeParam;
  const Dimensions dimensions{33, 33, 33};
  for (const SampleCoding coding : codings<Word>()) {
    const test::VolumePages<Word> volume(dimensions, random_samples<Word>(size_of(dimensions), 9));
    const auto codec = codec_of(coding, volume);
    for (const PageId& page : volume.pages()) {
      const Content<Word> content = content_of(volume, page);
      std::size_t own = 0;
      for (std::int32_t k = 0; k < 16; ++k)
        for (std::int32_t j = 0; j < 16; ++j)
          for (std::int32_t i = 0; i < 16; ++i) own += content.shape.owns({i, j, k}) ? sizeof(Word) : 0;
      EXPECT_LE(encoded(*codec, content).size(), own + 1);
    }
  }
}

TYPED_TEST(SampleCodecOf, CodesPagesThatItDidNotCount) {
  using Word = TypeParam;
  const Dimensions dimensions{35, 33, 20};
  const test::VolumePages<Word> flat(dimensions, std::vector<Word>(size_of(dimensions), 3));
  const test::VolumePages<Word> smooth(dimensions, smooth_samples<Word>(dimensions));
  const test::VolumePages<Word> noise(dimensions, random_samples<Word>(size_of(dimensions), 1));
  for (const SampleCoding coding : codings<Word>()) {
    for (const auto* counted : {&flat, &smooth, &noise}) {
      const auto codec = codec_of(coding, *counted);
      for (const auto* coded : {&flat, &smooth, &noise}) expect_there_and_back(*codec, *coded);
    }
    const auto none = sample_survey<Word>(coding, ranks_of(coding, flat))->codec();
    for (const auto* coded : {&flat, &smooth, &noise}) expect_there_and_back(*none, *coded);
    EXPECT_EQ(parse_sample_codec<Word>(coding, none->tables(), "none")->tables(), none->tables());
  }
}

TYPED_TEST(SampleCodecOf, IsTheSameForPagesInAnyOrder) {
  using Word = TypeParam;
  const Dimensions dimensions{40, 36, 33};
  const test::VolumePages<Word> volume(dimensions, smooth_samples<Word>(dimensions, 0.05));
  for (const SampleCoding coding : codings<Word>()) {
    const Bytes tables = codec_of(coding, volume)->tables();
    const auto ranks = ranks_of(coding, volume);
    const auto back = sample_survey<Word>(coding, ranks), first = sample_survey<Word>(coding, ranks),
               second = sample_survey<Word>(coding, ranks);
    for (std::size_t n = volume.pages().size(); n-- > 0;) {
      const Content<Word> content = content_of(volume, volume.pages()[n]);
      back->add(content.shape, content.around, content.samples);
      (n % 3 == 0 ? first : second)->add(content.shape, content.around, content.samples);
    }
    second->merge(*first);
    EXPECT_EQ(back->codec()->tables(), tables);
    EXPECT_EQ(second->codec()->tables(), tables);
  }
}

TYPED_TEST(SampleCodecOf, RefusesPagesThatAreCutOrTooLong) {
  using Word = TypeParam;
  const Dimensions dimensions{12, 9, 7};
  for (const SampleCoding coding : codings<Word>()) {
    for (const double noise : {0.0, 0.1, 3.0}) {
      const test::VolumePages<Word> volume(dimensions, smooth_samples<Word>(dimensions, noise));
      const auto codec = codec_of(coding, volume);
      typename SampleCodec<Word>::Samples found;
      for (std::size_t n = 0; n < 2; ++n) {
        const Content<Word> content = content_of(volume, volume.pages()[n]);
        Bytes bytes = encoded(*codec, content);
        for (std::size_t length = 0; length < bytes.size(); ++length) {
          const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
          ASSERT_FALSE(codec->decode(cut, content.shape, content.around, found)) << length;
        }
        bytes.push_back(std::byte{0});
        ASSERT_FALSE(codec->decode(bytes, content.shape, content.around, found));
      }
    }
  }
}

TYPED_TEST(SampleCodecOf, AnswersToFlippedBytes) {
  using Word = TypeParam;
  const Dimensions dimensions{18, 12, 10};
  std::mt19937_64 random(12);
  for (const SampleCoding coding : codings<Word>()) {
    const test::VolumePages<Word> volume(dimensions, smooth_samples<Word>(dimensions, 0.1));
    const auto codec = codec_of(coding, volume);
    auto found = std::make_unique<Content<Word>>();
    for (const PageId& page : volume.pages()) {
      const Content<Word> content = content_of(volume, page);
      const Bytes bytes = encoded(*codec, content);
      found->shape = content.shape;
      found->around = content.around;
      for (std::size_t at = 0; at < bytes.size(); ++at) {
        Bytes corrupt = bytes;
        corrupt[at] ^= static_cast<std::byte>(1 + random() % 255);
        // Bytes that are accepted decode to a page, mostly to another one. Raw bytes need not be the code of
        // that page.
        if (codec->decode(corrupt, content.shape, content.around, found->samples) &&
            corrupt[0] != std::byte{0}) {
          ASSERT_EQ(encoded(*codec, *found), corrupt) << at;
        }
      }
    }
  }
}

TYPED_TEST(SampleCodecOf, RefusesTablesThatAreCutOrTooLong) {
  using Word = TypeParam;
  const Dimensions dimensions{33, 20, 18};
  const test::VolumePages<Word> volume(dimensions, smooth_samples<Word>(dimensions, 0.1));
  for (const SampleCoding coding : codings<Word>()) {
    Bytes tables = codec_of(coding, volume)->tables();
    for (std::size_t length = 0; length < tables.size(); ++length) {
      const Bytes cut(tables.begin(), tables.begin() + static_cast<std::ptrdiff_t>(length));
      EXPECT_THROW(static_cast<void>(parse_sample_codec<Word>(coding, cut, "here")), Error) << length;
    }
    tables.push_back(std::byte{0});
    EXPECT_THROW(static_cast<void>(parse_sample_codec<Word>(coding, tables, "here")), Error);
  }
}

TYPED_TEST(SampleCodecOf, AnswersToFlippedBitsOfTables) {
  using Word = TypeParam;
  const Dimensions dimensions{18, 12, 10};
  const test::VolumePages<Word> volume(dimensions, smooth_samples<Word>(dimensions, 0.1));
  std::mt19937_64 random(13);
  for (const SampleCoding coding : codings<Word>()) {
    const Bytes tables = codec_of(coding, volume)->tables();
    for (int trial = 0; trial < 200; ++trial) {
      Bytes corrupt = tables;
      corrupt[random() % corrupt.size()] ^= static_cast<std::byte>(1u << random() % 8);
      try {
        const auto codec = parse_sample_codec<Word>(coding, corrupt, "here");
        ASSERT_EQ(codec->tables(), corrupt);
        if (trial < 40) expect_there_and_back(*codec, volume);
      } catch (const Error& error) {
        ASSERT_EQ(std::string(error.what()).rfind("here: ", 0), 0u) << error.what();
      }
    }
  }
}

TEST(SampleCodec, TakesSpecialFloats) {
  const Dimensions dimensions{34, 18, 20};
  constexpr std::uint32_t kSpecial[] = {0x7fc00001, 0xffc12345, 0x7f800001, 0x7f800000, 0xff800000,
                                        0x80000000, 0x00000000, 0x00000001, 0x807fffff, 0x3f800000};
  std::mt19937_64 random(14);
  std::vector<std::uint32_t> words(size_of(dimensions));
  for (std::size_t n = 0; n < words.size(); ++n) {
    const std::uint32_t bits = random() % 4 == 0
                                   ? kSpecial[random() % std::size(kSpecial)]
                                   : std::bit_cast<std::uint32_t>(std::sin(0.01f * static_cast<float>(n)));
    words[n] = ordered(std::bit_cast<float>(bits));
    ASSERT_EQ(std::bit_cast<std::uint32_t>(from_ordered<float>(words[n])), bits);
  }
  for (const SampleCoding coding : codings<std::uint32_t>())
    expect_there_and_back<std::uint32_t>(coding, dimensions, words);
}

TEST(SampleCodec, InterpolationMakesSmoothVolumesSmall) {
  const Dimensions dimensions{65, 65, 65};
  const auto samples = smooth_samples<std::uint8_t>(dimensions);
  const std::size_t split_edge = expect_there_and_back(SampleCoding::kSplitEdge, dimensions, samples);
  const std::size_t interpolation = expect_there_and_back(SampleCoding::kInterpolation, dimensions, samples);
  EXPECT_LT(interpolation, split_edge * 3 / 4);
  EXPECT_LT(interpolation, samples.size() / 6);
}

TEST(SampleCodec, RanksMakeFewDifferentFloatsSmall) {
  const Dimensions dimensions{65, 65, 65};
  std::vector<std::uint32_t> words;
  for (const std::uint8_t sample : smooth_samples<std::uint8_t>(dimensions))
    words.push_back(ordered(0.1f * static_cast<float>(sample) - 7));
  const std::size_t plain = expect_there_and_back(SampleCoding::kInterpolation, dimensions, words);
  const std::size_t ranks = expect_there_and_back(SampleCoding::kRanks, dimensions, words);
  EXPECT_LT(ranks, plain / 5);
}

}  // namespace
}  // namespace adamas
