#include "isosurface/compression/ranks/prevailing_sample.h"

#include <gtest/gtest.h>

#include <memory>

#include "tests/support/volume_pages.h"

namespace adamas {

using namespace isosurface;

namespace {

/// Returns the prevailing sample that is found in a volume with so many tenths of one sample, and others in
/// turn.
template <class Word>
std::optional<Word> found(std::size_t tenths, Word one, const SampleRanks* ranks = nullptr) {
  const std::array<std::uint64_t, 3> dimensions{40, 30, 20};
  std::vector<Word> samples;
  for (std::size_t n = 0; n < 24000; ++n)
    samples.push_back(n * 7 % 10 < tenths ? one : static_cast<Word>(3 + n % 5));
  const test::VolumePages<Word> volume(dimensions, std::move(samples));
  PrevailingSample<Word> prevailing(ranks);
  for (const PageId& page : volume.pages()) {
    test::PageContent<Word> content;
    volume.content(page, content, 0);
    prevailing.add(content.shape, content.samples);
  }
  return prevailing.found();
}

TEST(PrevailingSample, IsThatOfAQuarterOfThePointsOrMore) {
  EXPECT_EQ(found<std::uint8_t>(10, 200), 200);
  EXPECT_EQ(found<std::uint8_t>(4, 200), 200);
  EXPECT_EQ(found<std::uint8_t>(1, 200), std::nullopt);
}

TEST(PrevailingSample, OfMoreThanAByteIsThatOfFewRanks) {
  EXPECT_EQ(found<std::uint16_t>(9, 60000), std::nullopt);
  const SampleRanks few({3, 4, 5, 6, 7, 60000});
  EXPECT_EQ(found<std::uint16_t>(9, 60000, &few), 60000);
  std::vector<std::uint32_t> values;
  for (std::uint32_t n = 0; n < 257; ++n) values.push_back(n);
  values.push_back(60000);
  const SampleRanks many(values);
  EXPECT_EQ(found<std::uint16_t>(9, 60000, &many), std::nullopt);
}

}  // namespace
}  // namespace adamas
