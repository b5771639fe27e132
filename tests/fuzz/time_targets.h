#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "core/base/error.h"
#include "isosurface/storage/store_format.h"
#include "tests/fuzz/bounds_targets.h"
#include "tests/fuzz/sample_targets.h"
#include "timevarying/time_codec.h"

namespace adamas::fuzz {

using namespace isosurface;
using namespace timevarying;

/// The pages that a page is coded with: that of one step before and that of two steps before, and its
/// surroundings, which follow from a seed. All samples rise evenly in time.
template <class Word>
struct SeededSteps {
  std::array<EarlierPage<Word>, 2> before;
  typename SampleCodec<Word>::Around around;

  explicit SeededSteps(std::uint8_t seed) {
    SeededWords words(seed);
    const unsigned most = static_cast<Word>(~Word{0});
    words.fill(before[1].samples, most);
    words.fill(before[1].around, most);
    rise(before[1].samples, before[0].samples);
    rise(before[1].around, before[0].around);
    rise(before[0].around, around);
  }

  template <std::size_t N>
  static void rise(const std::array<Word, N>& from, std::array<Word, N>& to) {
    for (std::size_t n = 0; n < N; ++n) to[n] = static_cast<Word>(from[n] + n % 3);
  }
};

/// Parses tables and decodes a page with the pages that it is coded with. Accepted tables are written again
/// as they were read. The page comes back, with the bytes that it carries along, as the same bytes where
/// there is only one code for it.
template <class Word>
void time_codec_of(SampleCoding coding, const PageShape& shape, std::uint8_t seed,
                   std::span<const std::byte> tables, std::span<const std::byte> time_tables,
                   std::span<const std::byte> page) {
  const TimeCodec<Word> codec(coding, tables, time_tables, "fuzz");
  require(std::ranges::equal(codec.tables(), tables), "other tables");
  require(std::ranges::equal(codec.time_tables(), time_tables), "other tables of differences");
  const auto steps = std::make_unique<SeededSteps<Word>>(seed);
  const auto samples = std::make_unique<PagePoints<Word>>(), back = std::make_unique<PagePoints<Word>>();
  BytesAlong along, along_again;
  if (!codec.decode(page, shape, steps->around, steps->before, *samples, along))
    fail("expected a page, found other bytes");
  std::vector<std::byte> again;
  codec.encode(shape, steps->around, *samples, steps->before, again, along);
  require(codec.decode(again, shape, steps->around, steps->before, *back, along_again),
          "a page that is not taken");
  for_each_own_place(shape, [&](std::size_t n) { require((*back)[n] == (*samples)[n], "other samples"); });
  const std::size_t carried = carried_along(coding, again[0], along.size());
  require(
      std::equal(along.begin(), along.begin() + static_cast<std::ptrdiff_t>(carried), along_again.begin()),
      "other bytes carried along");
  const int order = time_order(page);
  const bool is_raw = (page[0] & std::byte{3}) == std::byte{0};
  if (is_raw || time_order(again) != order) return;
  const bool is_one = order == 0 ? has_one_code<Word>(coding, tables)
                                 : has_one_code<Word>(coding_of_bytes(coding), time_tables);
  if (is_one) require(std::ranges::equal(again, page), "another page");
}

/// The bytes are a header of 10 bytes, the tables, those of differences, and the page. The header is that of
/// sample_codec, the size of the tables of differences in 2 bytes, and a seed.
inline void time_codec(std::string_view bytes) {
  constexpr std::size_t kHeader = 10;
  const auto given = std::as_bytes(std::span(bytes));
  if (given.size() < kHeader) fail("expected a header, found {} bytes", given.size());
  const auto number = [given](std::size_t at) { return std::to_integer<int>(given[at]); };
  const SampleCoding coding = coding_in_header(number(0));
  const PageShape shape = shape_in_header(given);
  const auto rest = given.subspan(kHeader);
  const auto size = std::min(static_cast<std::size_t>(number(5) + 256 * number(6)), rest.size());
  const auto time_size = std::min(static_cast<std::size_t>(number(7) + 256 * number(8)), rest.size() - size);
  const auto tables = rest.first(size), time_tables = rest.subspan(size, time_size);
  const auto page = rest.subspan(size + time_size);
  const auto seed = static_cast<std::uint8_t>(number(9));
  with_word_in_header(number(0), [&](auto word) {
    time_codec_of<decltype(word)>(coding, shape, seed, tables, time_tables, page);
  });
}

}  // namespace adamas::fuzz
