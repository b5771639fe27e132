#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "isosurface/compression/sample_codec.h"
#include "isosurface/volume/page.h"

namespace adamas::isosurface {

// This header describes the file of a stored volume; docs/file_formats.md has its bytes.

/// The number of bytes of a file by parts of pages and their tables, without second copies of coarse pages.
struct StoreBytes {
  std::uint64_t samples = 0, bounds = 0, gradients = 0;  ///< bounds: errors and ranges
  std::uint64_t remainders = 0;                          ///< of numbers (number_remainders.h)

  StoreBytes& operator+=(const StoreBytes& other) {
    samples += other.samples;
    bounds += other.bounds;
    gradients += other.gradients;
    remainders += other.remainders;
    return *this;
  }
};

/// The greatest number of steps of a store and of a block, and of pages of a group.
inline constexpr std::uint32_t kMostSteps = 1u << 24, kMostBlockSteps = 256, kMostGroupPages = 512;

/// Pages of a series may be coded with those of the steps before, except at every kWholeSteps-th step from
/// the first one on. timevarying/ codes and decodes them in this way (TimeCodec); the functions below read
/// their marks.
inline constexpr std::uint32_t kWholeSteps = 8;

/// Returns the number of steps before this one that its pages may be coded with.
constexpr int steps_before(std::uint32_t step) { return static_cast<int>(std::min(step % kWholeSteps, 2u)); }

/// Returns the order of the differences in a coded page, which its first byte has above the two bits of the
/// page's kind: 0 in space, 1 or 2 in time. Orders up to 63 are possible in damaged pages.
constexpr int time_order(std::span<const std::byte> coded) {
  return coded.empty() ? 0 : std::to_integer<int>(coded[0]) >> 2;
}

/// The only byte of a page whose own points have the samples of the step before: of order 1, and of a kind
/// that differences do not have.
inline constexpr std::byte kAsBefore{3 | 1 << 2};

/// What samples are made from.
struct StoredNumbers {
  StoredType type = StoredType::kUint8;  ///< sample_type_for() returns that of samples
  std::string array{};                   ///< the array's name; empty where it has none

  bool operator==(const StoredNumbers&) const = default;
};

/// The size and checksum of a record of remainders. Records lie one after another.
struct RemainderRecord {
  std::uint64_t size = 0;  ///< 0 where all remainders are 0
  std::uint32_t checksum = 0;
};

/// The header of a block, which is one step in time or several that were added together. A volume is a block
/// of one step.
struct StoreHeader {
  VolumeGrid grid;        ///< the grid, which is the same in all blocks
  StoredNumbers numbers;  ///< the same in all blocks
  SampleCoding coding = SampleCoding::kInterpolation;
  bool gradients = false;         ///< whether pages hold directions of gradients; the same in all blocks
  std::uint32_t group_pages = 1;  ///< the number of page numbers in a group, a power of two (PageGroup)
  std::uint32_t first_step = 0;   ///< the number of steps of the blocks before
  std::vector<double> times{0};   ///< times of the block's steps, one or more, ascending
  StoreBytes bytes;
  /// The tables of the codecs. `time_tables` are those of differences in time; they are empty if no page of
  /// the block can have these.
  std::vector<std::byte> sample_tables, time_tables, bounds_tables, gradient_tables;

  [[nodiscard]] std::uint32_t steps() const { return static_cast<std::uint32_t>(times.size()); }
};

/// The directory's summary of the contents of a page.
struct PageSummary {
  /// The union of the ranges of the points' diamonds, as ordered words; low > high where all are empty.
  std::uint32_t low = 0, high = 0;
  /// The greatest error code of these diamonds, on the scale of the page's LOD. The coarsest page, which has
  /// diamonds of several LODs, has the greatest possible code.
  std::uint8_t error = 0;
  /// The greatest codes by isovalue. The words from low + 1 to high are divided into parts of 2^part_bits()
  /// words; a word stands for the isovalues of which it is the least word that is not below. The code of a
  /// part is at least that of each diamond that a contour for one of the part's isovalues crosses; it is 0
  /// where there is none, and else at most kSpan below `error`.
  static constexpr std::size_t kParts = 16;
  static constexpr int kSpan = 14;
  std::array<std::uint8_t, kParts> part_errors{};

  bool operator==(const PageSummary&) const = default;

  [[nodiscard]] int part_bits() const {
    return std::max(
        0, static_cast<int>(std::bit_width(high - low - 1)) - static_cast<int>(std::bit_width(kParts - 1)));
  }
  /// Returns the number of parts; 0 where no contour crosses a diamond with an error.
  [[nodiscard]] std::size_t part_count() const {
    return low < high && error > 0 ? ((high - low - 1) >> part_bits()) + 1 : 0;
  }
  /// Returns the part that has a word from low + 1 to high.
  [[nodiscard]] std::size_t part(std::uint32_t word) const { return (word - low - 1) >> part_bits(); }
};

/// Makes the summary of a page from the bounds of its own points.
template <class Word>
PageSummary summary(const PageShape& shape, const PageBounds<Word>& page);

struct PageEntry : PageSummary {
  std::uint64_t offset = 0;  ///< the offset in the file
  std::uint64_t copy = 0;    ///< the offset of the second copy, 0 where there is none
  std::uint32_t size = 0;    ///< size in bytes; 0 if the page is plain, which has no bytes
  std::uint32_t checksum = 0;
};

/// The records of remainders of a block: those of each step in the order of its planes.
struct RemainderTable {
  std::uint64_t offset = 0;              ///< the offset of the first record in the file
  std::vector<RemainderRecord> records;  ///< none where numbers have no remainders
};

/// Pages whose numbers are equal except for the last nine bits have their directory entries in one piece,
/// those of each page for all steps of the block one after another. Pages, and their copies, lie in the file
/// group by group (PageGroup).
struct DirectoryChunk {
  std::uint64_t first = 0;  ///< the least page number of the chunk, a multiple of kPages
  static constexpr std::uint64_t kPages = kMostGroupPages;

  std::uint64_t offset = 0, size = 0;  ///< offset and size of the entries in the file
  std::uint32_t checksum = 0;          ///< checksum of the entries
  std::uint64_t pages = 0;             ///< offset of the first page
  std::uint64_t copies = 0;            ///< offset of the first copy
};

/// Pages of this LOD and coarser ones, which have 1/512 of the samples, are in the file twice.
inline constexpr int kCopiedLod = 3;

/// The offset and size of the root of a block in the file.
struct RootPlace {
  std::uint64_t offset = 0, size = 0;

  [[nodiscard]] std::uint64_t end() const { return offset + size; }
  bool operator==(const RootPlace&) const = default;
};

/// The first bytes of a block that was added to a file. Bytes behind the last root of a file that begin with
/// these, or with a part of them, are an unfinished block.
inline constexpr std::array<std::uint8_t, 8> kBlockMark{0xad, 'b', 'l', 'o', 'c', 'k', '\r', '\n'};

/// The first bytes of a file, from which everything else is found.
struct StorePrologue {
  static constexpr std::size_t kBytes = 32;
  static constexpr std::uint32_t kVersion = 7;

  RootPlace root;  ///< the root of the last block

  [[nodiscard]] std::vector<std::byte> serialise() const;
  /// Reads the bytes. Throws Error, which begins with `name`, where they are not those of a store of this
  /// version.
  static StorePrologue parse(std::span<const std::byte> bytes, std::string_view name);
};

/// The last part of a block: the header and the places of the directory.
struct StoreRoot {
  StoreHeader header;
  RootPlace before;                    ///< the root of the block before; empty in the first block
  std::vector<DirectoryChunk> chunks;  ///< in ascending order of first page
  RemainderTable remainders;

  [[nodiscard]] std::vector<std::byte> serialise() const;
  /// Reads the bytes. Throws Error, which begins with `name`, where they are damaged or contradictory: chunks
  /// out of order or outside the `root_offset` bytes before the root.
  static StoreRoot parse(std::span<const std::byte> bytes, std::uint64_t root_offset, std::string_view name);
};

/// Returns the numbers of the pages of a chunk, in ascending order.
std::vector<std::uint64_t> chunk_pages(const PageGrid& grid, std::uint64_t first);

/// Returns the end of the group of the page at `begin`: the first page behind it whose number divided by
/// `group_pages` is another.
std::size_t group_end(std::span<const std::uint64_t> numbers, std::size_t begin, std::uint32_t group_pages);

/// Writes the entries of a chunk's pages in that order, each for all steps. Words have `word_bytes` bytes.
std::vector<std::byte> serialise_entries(std::span<const PageEntry> entries, std::size_t word_bytes);
/// Reads the entries of a chunk, and finds their offsets and copies. Returns none where the bytes are not
/// those of so many entries, or an error is no code.
std::optional<std::vector<PageEntry>> parse_entries(const PageGrid& grid, const DirectoryChunk& chunk,
                                                    const StoreHeader& block,
                                                    std::span<const std::byte> bytes);

}  // namespace adamas::isosurface
