#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <vector>

#include "tests/isosurface/sample_codec_checks.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::Bytes, test::codec_of, test::codings, test::content_of, test::Dimensions, test::encoded,
    test::expect_there_and_back, test::ranks_of, test::same_points, test::smooth_samples;
template <class Word>
using Content = test::PageContent<Word>;

template <class Word>
class PrevailingCodecOf : public testing::Test {};
using Words = testing::Types<std::uint8_t, std::uint16_t, std::uint32_t>;
TYPED_TEST_SUITE(PrevailingCodecOf, Words);

/// Returns a wave with noise that is cut off at `floor`, which most samples therefore have.
template <class Word>
std::vector<Word> cut_off_samples(const Dimensions& dimensions, Word floor) {
  std::vector<Word> samples = smooth_samples<Word>(dimensions, 0.1);
  std::vector<Word> sorted = samples;
  std::ranges::sort(sorted);
  const Word level = sorted[sorted.size() * 2 / 3], step = static_cast<Word>(sorted.back() / 120 + 1);
  for (Word& sample : samples)
    sample = sample < level ? floor : static_cast<Word>(floor + (sample - level) / step);
  return samples;
}

/// Expects that all pages come back with a codec that knows the prevailing sample. Returns the bytes of all
/// pages.
template <class Word>
std::size_t expect_prevailing_there_and_back(const test::VolumePages<Word>& volume,
                                             std::optional<Word> word) {
  const auto coding = sizeof(Word) == 1 ? SampleCoding::kInterpolation : SampleCoding::kRanks;
  const auto survey = sample_survey<Word>(coding, ranks_of(coding, volume), word);
  for (const PageId& page : volume.pages()) {
    const Content<Word> content = content_of(volume, page);
    survey->add(content.shape, content.around, content.samples);
  }
  const auto codec = survey->codec();
  const auto parsed = parse_sample_codec<Word>(coding, codec->tables(), "here");
  EXPECT_EQ(parsed->tables(), codec->tables());
  return expect_there_and_back(*parsed, volume);
}

TYPED_TEST(PrevailingCodecOf, ASampleThatPrevailsTakesFewerBytes) {
  using Word = TypeParam;
  const Dimensions dimensions{40, 37, 35};
  for (const Word floor : {Word{0}, Word{77}}) {
    const test::VolumePages<Word> volume(dimensions, cut_off_samples<Word>(dimensions, floor));
    const std::size_t without = expect_prevailing_there_and_back<Word>(volume, {});
    EXPECT_LT(expect_prevailing_there_and_back<Word>(volume, floor), without * 97 / 100);
    // The codec is lossless with any other sample too.
    expect_prevailing_there_and_back<Word>(volume, static_cast<Word>(floor + 5));
    expect_prevailing_there_and_back<Word>(volume, static_cast<Word>(floor + 140));
  }
}

TEST(PrevailingCodec, PagesWithAPrevailingSampleThatAreCutOrFlippedAreToldOrAreOthers) {
  const Dimensions dimensions{18, 12, 10};
  const test::VolumePages<std::uint8_t> volume(dimensions, cut_off_samples<std::uint8_t>(dimensions, 9));
  const auto survey = sample_survey<std::uint8_t>(SampleCoding::kInterpolation, nullptr, std::uint8_t{9});
  for (const PageId& page : volume.pages()) {
    const auto content = content_of(volume, page);
    survey->add(content.shape, content.around, content.samples);
  }
  const auto codec = survey->codec();
  std::mt19937_64 random(14);
  std::size_t refused = 0;
  BytesAlong along, along_again;
  SampleCodec<std::uint8_t>::Samples again;
  for (const PageId& page : volume.pages()) {
    auto content = content_of(volume, page);
    const Bytes bytes = encoded(*codec, content);
    for (std::size_t length = 0; length < bytes.size(); ++length)
      ASSERT_FALSE(codec->decode(std::span(bytes).first(length), content.shape, content.around, again));
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      Bytes corrupt = bytes;
      corrupt[at] ^= static_cast<std::byte>(1 + random() % 255);
      if (!codec->decode_with(corrupt, content.shape, content.around, content.samples, along)) {
        ++refused;
        continue;
      }
      Bytes coded;
      codec->encode_with(content.shape, content.around, content.samples, coded, along);
      ASSERT_TRUE(codec->decode_with(coded, content.shape, content.around, again, along_again));
      ASSERT_TRUE(same_points(content, again));
    }
  }
  EXPECT_GT(refused, 0u);
}

TYPED_TEST(PrevailingCodecOf, CarriesBytesAlong) {
  using Word = TypeParam;
  const Dimensions dimensions{35, 20, 18};
  std::mt19937_64 random(31);
  for (const SampleCoding coding : codings<Word>()) {
    for (const double noise : {0.0, 0.1, 30.0}) {
      const test::VolumePages<Word> volume(dimensions, smooth_samples<Word>(dimensions, noise));
      const auto codec = codec_of(coding, volume);
      for (const PageId& page : volume.pages()) {
        const Content<Word> content = content_of(volume, page);
        Bytes along(random() % 40), bytes;
        for (std::byte& byte : along) byte = static_cast<std::byte>(1 + random() % 255);
        codec->encode_with(content.shape, content.around, content.samples, bytes, along);
        typename SampleCodec<Word>::Samples found;
        BytesAlong carried;
        ASSERT_TRUE(codec->decode_with(bytes, content.shape, content.around, found, carried));
        EXPECT_TRUE(same_points(content, found));
        along.resize(carried_along(coding, bytes[0], along.size()));
        EXPECT_EQ(codec->decode(bytes, content.shape, content.around, found), along.empty());
        along.resize(carried.size());
        EXPECT_TRUE(std::ranges::equal(carried, along));
      }
    }
  }
}

}  // namespace
}  // namespace adamas
