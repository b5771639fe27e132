#pragma once

#include <algorithm>
#include <memory>
#include <string_view>

#include "core/base/error.h"
#include "isosurface/compression/byte_stream.h"
#include "isosurface/compression/gradients/gradient_codec.h"
#include "tests/fuzz/require.h"

namespace adamas::fuzz {

using namespace isosurface;

/// The bytes are a header of 6 bytes, the tables, and a page round which codes are a ramp. The header has 128
/// for SampleCoding::kInterpolation plus 1 where the page is complete; the points per axis; the size of the
/// tables in 2 bytes. Accepted bytes are written again as they were read, except raw ones, which need not be
/// the best.
inline void gradient_codec(std::string_view bytes) {
  constexpr std::size_t kHeader = 6;
  const auto given = std::as_bytes(std::span(bytes));
  if (given.size() < kHeader) fail("expected a header, found {} bytes", given.size());
  const auto number = [given](std::size_t at) { return std::to_integer<int>(given[at]); };
  const auto coding = number(0) >= 128 ? SampleCoding::kInterpolation : SampleCoding::kSplitEdge;
  const auto along = [&](std::size_t at) {
    return static_cast<std::int32_t>(number(at) % PageGrid::kSide + 1);
  };
  const PageShape shape{{along(1), along(2), along(3)}, number(0) % 2 != 0, 0};
  const auto size = std::min(static_cast<std::size_t>(number(4) + 256 * number(5)), given.size() - kHeader);
  const auto tables = given.subspan(kHeader, size), page = given.subspan(kHeader + size);
  const GradientCodec codec = GradientCodec::parse(coding, tables, "fuzz");
  require(std::ranges::equal(codec.tables(), tables), "other tables");
  GradientCodesAround around;
  for (std::size_t n = 0; n < around.size(); ++n) around[n] = static_cast<std::uint16_t>(n * n * 7);
  const auto codes = std::make_unique<GradientCodes>();
  if (!codec.decode(page, shape, around, *codes)) fail("expected a page, found other bytes");
  std::vector<std::byte> again;
  codec.encode(shape, around, *codes, again);
  ByteReader in(page);
  const auto first = in.sized_bytes(), second = in.rest();
  const bool raw = first[0] == std::byte{0} || second[0] == std::byte{0};
  require(raw || std::ranges::equal(again, page), "another page");
}

}  // namespace adamas::fuzz
