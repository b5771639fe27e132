#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "isosurface/compression/bounds/bounds_codec.h"
#include "tests/support/prepared_volume.h"

namespace adamas::test {

using namespace isosurface;

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

/// Returns a page of which only the samples are known.
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

/// Expects that all pages come back, both with the codec of all pages and with the codec that is parsed from
/// its tables. Returns the bytes of all pages.
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
Cases<OrderedWord<Sample>> cases_of(const PreparedVolume<Sample>& reference) {
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
  // Half of the words are near the ends of the range, and many of these are alike.
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

}  // namespace adamas::test
