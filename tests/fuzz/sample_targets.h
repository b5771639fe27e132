#pragma once

#include <algorithm>
#include <memory>
#include <string_view>

#include "core/base/error.h"
#include "isosurface/compression/byte_stream.h"
#include "isosurface/compression/ranks/ranked_codec.h"
#include "isosurface/compression/sample_codec.h"
#include "tests/fuzz/require.h"

namespace adamas::fuzz {

using namespace isosurface;

/// Returns whether each page has only one code besides the raw one. With a prevailing sample this does not
/// hold, since residuals may lead to that sample as well.
template <class Word>
bool has_one_code(SampleCoding coding, std::span<const std::byte> tables) {
  ByteReader in(tables);
  if (coding == SampleCoding::kSplitEdge || (coding == SampleCoding::kInterpolation && sizeof(Word) > 1))
    return true;
  if (coding == SampleCoding::kRanks &&
      SampleRanks::read(in.sized_bytes(), static_cast<int>(8 * sizeof(Word)), "fuzz").values().size() > 256)
    return true;
  return (in.number<std::uint8_t>() & 1) == 0;
}

/// Parses tables and decodes a page whose surroundings are a ramp. Accepted bytes are written again as they
/// were read, except a raw page, which need not be the best code. A page that has several codes comes back
/// with its samples.
template <class Word>
void sample_codec_of(SampleCoding coding, const PageShape& shape, std::span<const std::byte> tables,
                     std::span<const std::byte> page) {
  const auto codec = parse_sample_codec<Word>(coding, tables, "fuzz");
  require(std::ranges::equal(codec->tables(), tables), "other tables");
  typename SampleCodec<Word>::Around around;
  for (std::size_t n = 0; n < around.size(); ++n) around[n] = static_cast<Word>(n * n * 7);
  const auto samples = std::make_unique<typename SampleCodec<Word>::Samples>();
  if (!codec->decode(page, shape, around, *samples)) fail("expected a page, found other bytes");
  std::vector<std::byte> again;
  codec->encode(shape, around, *samples, again);
  if (page[0] == std::byte{0} || std::ranges::equal(again, page)) return;
  require(!has_one_code<Word>(coding, tables), "another page");
  const auto back = std::make_unique<typename SampleCodec<Word>::Samples>();
  require(codec->decode(again, shape, around, *back), "a page that is not taken");
  for_each_own_place(shape, [&](std::size_t n) { require((*back)[n] == (*samples)[n], "other samples"); });
}

/// Returns the coding in the first byte of a header: 128 for kInterpolation, 64 for kRanks.
inline SampleCoding coding_in_header(int first) {
  if (first >= 128) return SampleCoding::kInterpolation;
  return first >= 64 ? SampleCoding::kRanks : SampleCoding::kSplitEdge;
}

/// Returns the points per axis, and whether the page is complete, which follow the first byte.
inline PageShape shape_in_header(std::span<const std::byte> header) {
  const auto along = [&](std::size_t at) {
    return std::to_integer<std::int32_t>(header[at]) % PageGrid::kSide + 1;
  };
  return {{along(1), along(2), along(3)}, std::to_integer<int>(header[4]) % 2 != 0, 0};
}

/// Calls run(Word{}) for the size of samples in the first byte of a header.
template <class Run>
void with_word_in_header(int first, Run&& run) {
  const int word = first % 64;
  if (word == 1) return run(std::uint8_t{});
  if (word == 2) return run(std::uint16_t{});
  if (word == 4) return run(std::uint32_t{});
  fail("expected samples of 1, 2 or 4 bytes, found {}", word);
}

/// The bytes are a header of 7 bytes, the tables and the page. The header has the size of a sample plus 128
/// for kInterpolation or 64 for kRanks; the points per axis; whether the page is complete; the size of the
/// tables in 2 bytes.
inline void sample_codec(std::string_view bytes) {
  constexpr std::size_t kHeader = 7;
  const auto given = std::as_bytes(std::span(bytes));
  if (given.size() < kHeader) fail("expected a header, found {} bytes", given.size());
  const auto number = [given](std::size_t at) { return std::to_integer<int>(given[at]); };
  const SampleCoding coding = coding_in_header(number(0));
  const PageShape shape = shape_in_header(given);
  const auto size = std::min(static_cast<std::size_t>(number(5) + 256 * number(6)), given.size() - kHeader);
  const auto tables = given.subspan(kHeader, size), page = given.subspan(kHeader + size);
  with_word_in_header(number(0),
                      [&](auto word) { sample_codec_of<decltype(word)>(coding, shape, tables, page); });
}

}  // namespace adamas::fuzz
