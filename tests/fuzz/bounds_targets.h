#pragma once

#include <algorithm>
#include <memory>
#include <string_view>

#include "core/base/error.h"
#include "isosurface/compression/bounds/bounds_codec.h"
#include "tests/fuzz/require.h"

namespace adamas::fuzz {

using namespace isosurface;

/// Words of which most are similar; the seed decides how many are not.
class SeededWords {
 public:
  explicit SeededWords(std::uint8_t seed) : seed_(seed) {}

  template <class Number, std::size_t N>
  void fill(std::array<Number, N>& numbers, unsigned most) {
    for (Number& number : numbers) {
      state_ = state_ * 1664525u + 1013904223u;
      const std::uint32_t smooth = seed_ / 4u + (state_ >> 30 & seed_), wild = state_ >> 7;
      number = static_cast<Number>((state_ >> 24 < seed_ ? wild : smooth) & most);
    }
  }

 private:
  std::uint32_t seed_;
  std::uint32_t state_ = 1;
};

/// Fills the samples of a page and its surroundings.
template <class Word>
void seeded_page(std::uint8_t seed, Page<Word>& page, Surroundings<Word>& around) {
  SeededWords words(seed);
  const unsigned most = static_cast<Word>(~Word{0});
  words.fill(page.samples, most);
  words.fill(around.samples, most);
  words.fill(around.low, most);
  words.fill(around.high, most);
  words.fill(around.errors, 63);
}

/// Parses tables and decodes a page with them; its samples and surroundings follow from the seed. Accepted
/// bytes are written again as they were read.
template <class Word>
void bounds_page(std::span<const std::byte> tables, std::span<const std::byte> bytes, const PageShape& shape,
                 std::uint8_t seed) {
  const auto codec = BoundsCodec<Word>::parse(tables, {1, 1, 1}, "fuzz");
  require(std::ranges::equal(codec.tables(), tables), "other tables");
  const auto around = std::make_unique<Surroundings<Word>>();
  const auto page = std::make_unique<Page<Word>>();
  seeded_page(seed, *page, *around);
  if (!codec.decode(bytes, shape, *around, *page, *page)) fail("expected a page, found other bytes");
  std::vector<std::byte> again;
  codec.encode(shape, *around, *page, again);
  require(std::ranges::equal(again, bytes), "another page");
}

/// The bytes are a number of bits, the page's count per axis, its LOD plus 128 where it is complete, a seed,
/// the size of the tables in 2 bytes, the tables, and the page.
inline void bounds_codec(std::string_view bytes) {
  constexpr std::size_t kHeader = 8;
  const auto given = std::as_bytes(std::span(bytes));
  if (given.size() < kHeader) fail("expected a header, found {} bytes", given.size());
  const auto number = [given](std::size_t at) { return std::to_integer<int>(given[at]); };
  const int bits = number(0);
  const auto side = [&number](std::size_t at) { return 1 + (number(at) & 15); };
  const PageShape shape{{side(1), side(2), side(3)}, (number(4) & 128) != 0, number(4) & 15};
  const auto seed = static_cast<std::uint8_t>(number(5));
  const std::size_t size =
      std::min<std::size_t>(static_cast<std::size_t>(number(6) | number(7) << 8), given.size() - kHeader);
  const auto tables = given.subspan(kHeader, size), page = given.subspan(kHeader + size);
  if (bits == 8) return bounds_page<std::uint8_t>(tables, page, shape, seed);
  if (bits == 16) return bounds_page<std::uint16_t>(tables, page, shape, seed);
  if (bits == 32) return bounds_page<std::uint32_t>(tables, page, shape, seed);
  fail("expected 8, 16 or 32 bits, found {}", bits);
}

}  // namespace adamas::fuzz
