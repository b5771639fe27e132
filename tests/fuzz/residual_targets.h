#pragma once

#include <algorithm>
#include <string_view>

#include "core/base/error.h"
#include "isosurface/compression/split_edge/residual_code.h"
#include "tests/fuzz/require.h"

namespace adamas::fuzz {

using namespace isosurface;

/// The bytes are a number of bits, the sizes of the tables and of the page's residuals in 2 bytes each, the
/// tables, and the page. Accepted bytes are written again as they were read.
inline void residual_code(std::string_view bytes) {
  constexpr std::size_t kHeader = 5, kMostResiduals = 4096;
  const auto given = std::as_bytes(std::span(bytes));
  if (given.size() < kHeader) fail("expected a header, found {} bytes", given.size());
  const auto number = [given](std::size_t at) {
    return std::to_integer<std::size_t>(given[at]) | std::to_integer<std::size_t>(given[at + 1]) << 8;
  };
  const int bits = std::to_integer<int>(given[0]);
  if (bits != 8 && bits != 16 && bits != 32) fail("expected 8, 16 or 32 bits, found {}", bits);
  const std::size_t table_size = std::min(number(1), given.size() - kHeader);
  const auto tables = given.subspan(kHeader, table_size);
  const auto page = given.subspan(kHeader + table_size);

  const ResidualCode code = ResidualCode::parse(tables, bits, "fuzz");
  require(std::ranges::equal(code.serialise(), tables), "other tables");
  std::vector<std::uint32_t> residuals(std::min(number(3), kMostResiduals));
  if (!code.decode(page, residuals)) fail("expected a page, found other bytes");
  std::vector<std::byte> again;
  code.encode(residuals, again);
  require(std::ranges::equal(again, page), "another page");
}

}  // namespace adamas::fuzz
