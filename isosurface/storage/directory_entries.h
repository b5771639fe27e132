#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "isosurface/storage/store_format.h"

namespace adamas::isosurface {

/// Numbers of the pages that a chunk has, in ascending order.
std::vector<std::uint64_t> chunk_pages(const PageGrid& grid, std::uint64_t first);

/// Where the group ends that the page at `begin` is in: the first page behind it whose number divided by
/// `group_pages` is another.
std::size_t group_end(std::span<const std::uint64_t> numbers, std::size_t begin, std::uint32_t group_pages);

/// The entries of a chunk's pages in that order, each of all steps. Words have `word_bytes` bytes.
std::vector<std::byte> serialise_entries(std::span<const PageEntry> entries, std::size_t word_bytes);
/// Offsets and copies too. Nothing where the bytes are not those of so many entries, or an error is no code.
std::optional<std::vector<PageEntry>> parse_entries(const PageGrid& grid, const DirectoryChunk& chunk,
                                                    const StoreHeader& block,
                                                    std::span<const std::byte> bytes);

}  // namespace adamas::isosurface
