#include "isosurface/storage/directory_entries.h"

#include <bit>
#include <cstring>

#include "isosurface/compression/byte_stream.h"
#include "isosurface/volume/error_scale.h"

namespace adamas::isosurface {

namespace {

/// Four bits for each part, the first lowest: 0 where nothing is crossed, else 15 less what its greatest
/// error is below that of the page.
void write_part_errors(ByteWriter& out, const PageSummary& summary) {
  const std::size_t count = summary.part_count();
  for (std::size_t n = 0; n < count; n += 2) {
    const auto bits = [&](std::size_t part) {
      const int error = part < count ? summary.part_errors[part] : 0;
      return error == 0 ? 0 : PageSummary::kSpan + 1 - (summary.error - error);
    };
    out.number(static_cast<std::uint8_t>(bits(n) | bits(n + 1) << 4));
  }
}

/// False where an error is no code.
bool read_part_errors(ByteReader& in, PageSummary& summary) {
  const std::size_t count = summary.part_count();
  for (std::size_t n = 0; n < count; n += 2) {
    const auto both = in.number<std::uint8_t>();
    if (n + 1 == count && both >> 4 != 0) return false;
    for (const std::size_t part : {n, n + 1}) {
      const int bits = part == n ? both & 15 : both >> 4;
      if (bits == 0) continue;
      const int error = summary.error - (PageSummary::kSpan + 1 - bits);
      if (error < 1) return false;
      summary.part_errors[part] = static_cast<std::uint8_t>(error);
    }
  }
  return true;
}

}  // namespace

std::vector<std::uint64_t> chunk_pages(const PageGrid& grid, std::uint64_t first) {
  std::vector<std::uint64_t> numbers;
  for (std::uint64_t number = first; number < first + DirectoryChunk::kPages; ++number) {
    // Numbers between those of two LODs are nobody's.
    if (number == 0 || (std::bit_width(number) - 1) % 3 != 0) continue;
    if (grid.contains(grid.page(number))) numbers.push_back(number);
  }
  return numbers;
}

std::size_t group_end(std::span<const std::uint64_t> numbers, std::size_t begin, std::uint32_t group_pages) {
  std::size_t end = begin + 1;
  while (end < numbers.size() && numbers[end] / group_pages == numbers[begin] / group_pages) ++end;
  return end;
}

std::vector<std::byte> serialise_entries(std::span<const PageEntry> entries, std::size_t word_bytes) {
  std::vector<std::byte> bytes;
  ByteWriter out(bytes);
  const auto put_range = [&](const PageEntry& entry) {
    for (const std::uint32_t word : {entry.low, entry.high})
      out.bytes(std::as_bytes(std::span(&word, 1)).first(word_bytes));
  };
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    const PageEntry& entry = entries[begin];
    const auto is_alike = [&](const PageEntry& other) {
      return other.size == 0 && other.low == entry.low && other.high == entry.high;
    };
    end = begin + 1;
    out.varint(entry.size);
    if (entry.size == 0) {
      while (end < entries.size() && is_alike(entries[end])) ++end;
      out.varint(end - begin);
      put_range(entry);
      continue;
    }
    out.number(entry.checksum);
    put_range(entry);
    out.number(entry.error);
    write_part_errors(out, entry);
  }
  return bytes;
}

namespace {

/// Takes the entries of pages one after another, without offsets.
class EntryReader {
 public:
  /// `most`: how many there may be.
  EntryReader(std::span<const std::byte> bytes, std::size_t word_bytes, std::uint64_t most)
      : in_(bytes), word_bytes_(word_bytes), most_(most) {}

  /// Nothing where the bytes are not those of an entry, or a stretch of plain pages goes on from another.
  std::optional<PageEntry> take() {
    if (plain_left_ == 0) {
      const std::uint64_t size = in_.varint();
      if (size > ~std::uint32_t{0}) return {};
      if (size > 0) return take_page(static_cast<std::uint32_t>(size));
      const PageEntry before = plain_;
      plain_left_ = in_.varint();
      take_range(plain_);
      const bool goes_on = follows_plain_ && static_cast<const PageSummary&>(plain_) == before;
      if (plain_left_ == 0 || plain_left_ > most_ || goes_on) return {};
    }
    --plain_left_;
    follows_plain_ = true;
    return plain_;
  }
  [[nodiscard]] bool at_end() const { return plain_left_ == 0 && in_.good() && in_.rest().empty(); }

 private:
  void take_range(PageSummary& summary) {
    for (std::uint32_t* const word : {&summary.low, &summary.high}) {
      *word = 0;
      const auto from = in_.bytes(word_bytes_);
      if (!from.empty()) std::memcpy(word, from.data(), word_bytes_);
    }
  }
  std::optional<PageEntry> take_page(std::uint32_t size) {
    follows_plain_ = false;
    PageEntry entry;
    entry.size = size;
    entry.checksum = in_.number<std::uint32_t>();
    take_range(entry);
    entry.error = in_.number<std::uint8_t>();
    if (entry.error >= ErrorScale::kCodes || !read_part_errors(in_, entry)) return {};
    return entry;
  }

  ByteReader in_;
  std::size_t word_bytes_;
  std::uint64_t most_;
  PageEntry plain_;  ///< of the stretch of plain pages that was begun last
  std::uint64_t plain_left_ = 0;
  bool follows_plain_ = false;
};

/// Where the pages of a chunk lie: group by group, of each one step after another.
void place_entries(const PageGrid& grid, const DirectoryChunk& chunk, const StoreHeader& block,
                   std::span<const std::uint64_t> numbers, std::vector<PageEntry>& entries) {
  const std::size_t steps = block.steps();
  std::uint64_t offset = chunk.pages, copy = chunk.copies;
  for (std::size_t begin = 0, end = 0; begin < numbers.size(); begin = end) {
    end = group_end(numbers, begin, block.group_pages);
    for (std::size_t step = 0; step < steps; ++step) {
      for (std::size_t row = begin; row < end; ++row) {
        PageEntry& entry = entries[row * steps + step];
        entry.offset = offset;
        offset += entry.size;
        if (grid.page(numbers[row]).lod < kCopiedLod) continue;
        entry.copy = copy;
        copy += entry.size;
      }
    }
  }
}

}  // namespace

std::optional<std::vector<PageEntry>> parse_entries(const PageGrid& grid, const DirectoryChunk& chunk,
                                                    const StoreHeader& block,
                                                    std::span<const std::byte> bytes) {
  const std::vector<std::uint64_t> numbers = chunk_pages(grid, chunk.first);
  const std::size_t count = numbers.size() * block.steps();
  EntryReader in(bytes, sample_bytes(block.grid.type), count);
  std::vector<PageEntry> entries;
  while (entries.size() < count) {
    const std::optional<PageEntry> entry = in.take();
    if (!entry) return {};
    entries.push_back(*entry);
  }
  if (!in.at_end()) return {};
  place_entries(grid, chunk, block, numbers, entries);
  return entries;
}

}  // namespace adamas::isosurface
