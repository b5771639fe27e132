#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "core/base/checksum.h"
#include "core/base/error.h"
#include "isosurface/storage/store_format.h"
#include "tests/fuzz/require.h"

namespace adamas::fuzz {

using namespace isosurface;

/// Returns the bytes with their checksum behind them.
inline std::vector<std::byte> with_checksum(std::span<const std::byte> bytes) {
  std::vector<std::byte> result(bytes.begin(), bytes.end());
  const std::uint32_t checksum = crc32c(bytes);
  const auto behind = std::as_bytes(std::span(&checksum, 1));
  result.insert(result.end(), behind.begin(), behind.end());
  return result;
}

/// Requires that pages follow each other without gaps, in the order of groups, then of steps, then of pages,
/// and that their copies do so too.
inline void require_no_gaps(const StoreHeader& block, const PageGrid& grid, const DirectoryChunk& chunk,
                            std::span<const std::uint64_t> numbers, std::span<const PageEntry> entries) {
  std::vector<std::array<std::uint64_t, 4>> order;
  for (std::size_t n = 0; n < entries.size(); ++n) {
    const std::uint64_t number = numbers[n / block.steps()];
    order.push_back({number / block.group_pages, n % block.steps(), number, n});
  }
  std::ranges::sort(order);
  std::uint64_t offset = chunk.pages, copy = chunk.copies;
  for (const auto& place : order) {
    const PageEntry& entry = entries[place[3]];
    const bool is_copied = grid.page(place[2]).lod >= kCopiedLod;
    require(entry.offset == offset && entry.copy == (is_copied ? copy : 0), "pages with gaps");
    require(entry.error < 64, "an error without a code");
    offset += entry.size;
    copy += is_copied ? entry.size : 0;
  }
}

/// Parses the parts of a directory one after another; their sizes are in the root. Accepted parts are written
/// again as they were read.
inline void store_directory(const StoreRoot& root, std::span<const std::byte> bytes) {
  const PageGrid grid(root.header.grid.dimensions);
  const std::size_t word_bytes = sample_bytes(root.header.grid.type);
  const std::uint32_t steps = root.header.steps();
  for (const DirectoryChunk& chunk : root.chunks) {
    const auto part =
        bytes.first(static_cast<std::size_t>(std::min<std::uint64_t>(chunk.size, bytes.size())));
    bytes = bytes.subspan(part.size());
    const auto entries = parse_entries(grid, chunk, root.header, part);
    if (!entries) fail("expected a part of the directory, found other bytes");
    require(std::ranges::equal(serialise_entries(*entries, word_bytes), part), "another part");
    const auto numbers = chunk_pages(grid, chunk.first);
    require(entries->size() == steps * numbers.size(), "pages without entries");
    require_no_gaps(root.header, grid, chunk, numbers, *entries);
  }
}

/// The bytes are all of a store but its pages: the 20 bytes of the prologue between its name and its
/// checksum; the size of the root in 2 bytes; the root without its checksum; the parts of the directory.
/// Accepted bytes are written again as they were read, and have no more pages than the directory has room
/// for.
inline void store_format(std::string_view bytes) {
  constexpr std::size_t kMagic = 8, kPrologue = StorePrologue::kBytes - kMagic - 4, kHeader = kPrologue + 2;
  const auto given = std::as_bytes(std::span(bytes));
  if (given.size() < kHeader) fail("expected a header, found {} bytes", given.size());
  auto first = StorePrologue{}.serialise();
  first.resize(StorePrologue::kBytes - 4);
  std::copy_n(given.begin(), kPrologue, first.begin() + kMagic);
  first = with_checksum(first);
  const StorePrologue prologue = StorePrologue::parse(first, "fuzz");
  require(prologue.serialise() == first, "another prologue");

  const auto size = std::to_integer<std::size_t>(given[kPrologue]) +
                    256 * std::to_integer<std::size_t>(given[kPrologue + 1]);
  const auto rest = given.subspan(kHeader);
  const auto last = with_checksum(rest.first(std::min(size, rest.size())));
  const StoreRoot root = StoreRoot::parse(last, prologue.root.offset, "fuzz");
  require(root.serialise() == last, "another root");
  for (const DirectoryChunk& chunk : root.chunks)
    require(chunk.offset + chunk.size <= prologue.root.offset, "a directory beyond the root");
  const std::uint64_t pages = PageGrid(root.header.grid.dimensions).page_count();
  require(pages <= root.chunks.size() * DirectoryChunk::kPages, "pages without a directory");
  store_directory(root, rest.subspan(last.size() - 4));
}

}  // namespace adamas::fuzz
