#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include "isosurface/compression/ranks/ranked_codec.h"
#include "isosurface/compression/sample_codec.h"
#include "tests/support/volume_pages.h"

namespace adamas::test {

using namespace isosurface;

using Bytes = std::vector<std::byte>;
using Dimensions = std::array<std::uint64_t, 3>;

/// Returns all codings of these words; single bytes have no ranks.
template <class Word>
std::vector<SampleCoding> codings() {
  std::vector<SampleCoding> all{SampleCoding::kSplitEdge, SampleCoding::kInterpolation};
  if (sizeof(Word) > 1) all.push_back(SampleCoding::kRanks);
  return all;
}

template <class Word>
using Content = PageContent<Word>;

inline std::size_t size_of(const Dimensions& dimensions) {
  return dimensions[0] * dimensions[1] * dimensions[2];
}

template <class Word>
Content<Word> content_of(const VolumePages<Word>& volume, const PageId& page, Word unused = 0) {
  Content<Word> content;
  volume.content(page, content, unused);
  return content;
}

/// Returns the ranks of the volume's samples, or of the least of them where there are too many; null for all
/// codings but kRanks.
template <class Word>
std::shared_ptr<const SampleRanks> ranks_of(SampleCoding coding, const VolumePages<Word>& volume) {
  if (coding != SampleCoding::kRanks) return nullptr;
  std::set<std::uint32_t> values;
  for (const PageId& page : volume.pages()) {
    const Content<Word> content = content_of(volume, page);
    values.insert(content.samples.begin(), content.samples.end());
  }
  std::vector<std::uint32_t> sorted(values.begin(), values.end());
  sorted.resize(std::min(sorted.size(), SampleRanks::kMost));
  return std::make_shared<const SampleRanks>(std::move(sorted));
}

template <class Word>
std::unique_ptr<SampleCodec<Word>> codec_of(SampleCoding coding, const VolumePages<Word>& volume) {
  const auto survey = sample_survey<Word>(coding, ranks_of(coding, volume));
  for (const PageId& page : volume.pages()) {
    const Content<Word> content = content_of(volume, page);
    survey->add(content.shape, content.around, content.samples);
  }
  return survey->codec();
}

template <class Word>
Bytes encoded(const SampleCodec<Word>& codec, const Content<Word>& content) {
  Bytes bytes;
  codec.encode(content.shape, content.around, content.samples, bytes);
  return bytes;
}

/// Returns whether all points of a page have these samples.
template <class Word>
bool same_points(const Content<Word>& content, const typename SampleCodec<Word>::Samples& found) {
  const LatticePoint n = content.shape.count;
  for (std::int32_t k = 0; k < n.k; ++k)
    for (std::int32_t j = 0; j < n.j; ++j)
      for (std::int32_t i = 0; i < n.i; ++i) {
        const std::size_t place = PageGrid::place({i, j, k}, 0);
        if (content.samples[place] != found[place]) return false;
      }
  return true;
}

/// Expects that every page comes back, whatever lies where it has no points. Returns the bytes of all pages.
template <class Word>
std::size_t expect_there_and_back(const SampleCodec<Word>& codec, const VolumePages<Word>& volume) {
  std::size_t total = 0;
  typename SampleCodec<Word>::Samples found;
  for (const PageId& page : volume.pages()) {
    const Content<Word> content = content_of(volume, page);
    const Bytes bytes = encoded(codec, content);
    EXPECT_EQ(encoded(codec, content_of(volume, page, static_cast<Word>(0xa5a5a5a5))), bytes);
    found.fill(77);
    const bool taken = codec.decode(bytes, content.shape, content.around, found);
    EXPECT_TRUE(taken);
    EXPECT_TRUE(same_points(content, found)) << "level " << page.lod;
    EXPECT_LE(bytes.size(), 1 + PageGrid::kPoints * sizeof(Word));
    total += bytes.size();
  }
  return total;
}

/// Expects that all pages come back with the volume's own codec and with the codec parsed from its tables.
/// Returns the bytes of all pages.
template <class Word>
std::size_t expect_there_and_back(SampleCoding coding, const Dimensions& dimensions,
                                  std::vector<Word> samples) {
  const VolumePages<Word> volume(dimensions, std::move(samples));
  const auto codec = codec_of(coding, volume);
  const std::size_t total = expect_there_and_back(*codec, volume);
  const Bytes tables = codec->tables();
  const auto parsed = parse_sample_codec<Word>(coding, tables, "here");
  EXPECT_EQ(parsed->tables(), tables);
  EXPECT_EQ(expect_there_and_back(*parsed, volume), total);
  return total;
}

template <class Word>
std::vector<Word> random_samples(std::size_t size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Word> samples(size);
  for (Word& sample : samples) sample = static_cast<Word>(random() >> 17);
  return samples;
}

template <class Word>
std::vector<Word> smooth_samples(const Dimensions& dimensions, double noise = 0) {
  std::mt19937_64 random(5);
  std::vector<Word> samples;
  const double half = static_cast<double>(std::numeric_limits<Word>::max()) / 2;
  for (std::uint64_t k = 0; k < dimensions[2]; ++k)
    for (std::uint64_t j = 0; j < dimensions[1]; ++j)
      for (std::uint64_t i = 0; i < dimensions[0]; ++i) {
        const double wave =
            std::sin(0.11 * static_cast<double>(i)) * std::cos(0.07 * static_cast<double>(j)) +
            std::sin(0.09 * static_cast<double>(k) + 1);
        const double rough = noise * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5);
        samples.push_back(static_cast<Word>(std::clamp(half * (1 + wave / 2.1 + rough), 0.0, 2 * half)));
      }
  return samples;
}

}  // namespace adamas::test
