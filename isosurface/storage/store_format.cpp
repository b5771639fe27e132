#include "isosurface/storage/store_format.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/base/checksum.h"
#include "core/base/error.h"
#include "core/data/anatomical_space.h"
#include "isosurface/compression/byte_stream.h"
#include "isosurface/storage/number_remainders.h"
#include "isosurface/volume/error_scale.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

namespace {

// A carriage return and a line feed show transfers that treated the file as text.
constexpr std::array<char, 8> kMagic{'a', 'd', 'a', 'm', 'a', 's', '\r', '\n'};
/// The shift of the bits of the size of groups in the byte whose lowest bit says whether there are gradients.
constexpr int kGroupShift = 4;

void write_grid(ByteWriter& out, const VolumeGrid& grid) {
  out.number(static_cast<std::uint8_t>(grid.type));
  for (const std::uint64_t n : grid.dimensions) out.number(n);
  for (int axis = 0; axis < 3; ++axis) out.number(grid.spacing[axis]);
  for (int axis = 0; axis < 3; ++axis) out.number(grid.origin[axis]);
  for (const Vec3& direction : grid.directions) {
    for (int axis = 0; axis < 3; ++axis) out.number(direction[axis]);
  }
  for (const std::string* text : {&grid.space, &grid.length_unit, &grid.value_unit})
    out.sized_bytes(std::as_bytes(std::span(*text)));
  out.number(grid.slope);
  out.number(grid.intercept);
}

VolumeGrid read_grid(ByteReader& in, std::string_view name) {
  VolumeGrid grid;
  const auto type = in.number<std::uint8_t>();
  if (type > static_cast<std::uint8_t>(SampleType::kFloat32))
    fail("{}: expected a type of samples from 0 to 3, found {}", name, type);
  grid.type = static_cast<SampleType>(type);
  for (std::uint64_t& n : grid.dimensions) n = in.number<std::uint64_t>();
  for (int axis = 0; axis < 3; ++axis) grid.spacing[axis] = in.number<double>();
  for (int axis = 0; axis < 3; ++axis) grid.origin[axis] = in.number<double>();
  for (Vec3& direction : grid.directions) {
    for (int axis = 0; axis < 3; ++axis) direction[axis] = in.number<double>();
  }
  for (std::string* text : {&grid.space, &grid.length_unit, &grid.value_unit}) {
    const auto bytes = in.sized_bytes();
    text->assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  if (!grid.space.empty() && !is_space(grid.space))
    fail("{}: expected the name of a space of coordinates, found another", name);
  grid.slope = in.number<double>();
  grid.intercept = in.number<double>();
  return grid;
}

StoredNumbers read_numbers(ByteReader& in, const VolumeGrid& grid, std::string_view name) {
  StoredNumbers numbers;
  const auto type = in.number<std::uint8_t>();
  if (type > static_cast<std::uint8_t>(StoredType::kFloat64))
    fail("{}: expected a type of numbers from 0 to 9, found {}", name, type);
  numbers.type = static_cast<StoredType>(type);
  if (sample_type_for(numbers.type) != grid.type)
    fail("{}: expected a type of numbers that are {} as samples, found {}", name, sample_name(grid.type),
         type);
  const auto array = in.sized_bytes();
  numbers.array.assign(reinterpret_cast<const char*>(array.data()), array.size());
  return numbers;
}

void write_header(ByteWriter& out, const StoreHeader& header) {
  write_grid(out, header.grid);
  out.number(static_cast<std::uint8_t>(header.numbers.type));
  out.sized_bytes(std::as_bytes(std::span(header.numbers.array)));
  out.number(static_cast<std::uint8_t>(header.coding));
  const int group_bits = std::countr_zero(header.group_pages);
  out.number(static_cast<std::uint8_t>(static_cast<int>(header.gradients) | group_bits << kGroupShift));
  out.number(header.first_step);
  out.varint(header.times.size());
  for (const double time : header.times) out.number(time);
  for (const std::uint64_t n :
       {header.bytes.samples, header.bytes.bounds, header.bytes.gradients, header.bytes.remainders})
    out.number(n);
  for (const auto* tables :
       {&header.sample_tables, &header.time_tables, &header.bounds_tables, &header.gradient_tables})
    out.sized_bytes(*tables);
}

void read_times(ByteReader& in, StoreHeader& header, std::string_view name) {
  const std::uint64_t count = in.varint();
  if (count == 0 || count > kMostBlockSteps || header.first_step > kMostSteps - count ||
      count > in.rest().size() / sizeof(double))
    fail("{}: expected from 1 to {} steps in a block, found {} from step {} on", name, kMostBlockSteps, count,
         header.first_step);
  header.times.clear();
  for (std::uint64_t n = 0; n < count; ++n) {
    const auto time = in.number<double>();
    if (!std::isfinite(time) || (n > 0 && time <= header.times.back()))
      fail("{}: expected times of steps that ascend, found others", name);
    header.times.push_back(time);
  }
}

StoreHeader read_header(ByteReader& in, std::string_view name) {
  StoreHeader header;
  header.grid = read_grid(in, name);
  header.numbers = read_numbers(in, header.grid, name);
  const auto choice = [&](const char* what, int most) {
    const auto value = in.number<std::uint8_t>();
    if (value > most) fail("{}: expected {} from 0 to {}, found {}", name, what, most, value);
    return value;
  };
  header.coding = static_cast<SampleCoding>(choice("a coding of samples", 2));
  const auto layout = in.number<std::uint8_t>();
  const int group_bits = layout >> kGroupShift;
  if ((layout & ~1 & ((1 << kGroupShift) - 1)) != 0 || kMostGroupPages >> group_bits == 0)
    fail("{}: expected gradients or none, and groups of up to {} pages, found {}", name, kMostGroupPages,
         layout);
  header.gradients = (layout & 1) != 0;
  header.group_pages = 1u << group_bits;
  header.first_step = in.number<std::uint32_t>();
  read_times(in, header, name);
  for (std::uint64_t* n :
       {&header.bytes.samples, &header.bytes.bounds, &header.bytes.gradients, &header.bytes.remainders})
    *n = in.number<std::uint64_t>();
  for (auto* tables :
       {&header.sample_tables, &header.time_tables, &header.bounds_tables, &header.gradient_tables}) {
    const auto bytes = in.sized_bytes();
    tables->assign(bytes.begin(), bytes.end());
  }
  if (!in.good()) fail("{}: expected a header, found its end too soon", name);
  header.grid.check(std::string(name));
  for (const std::uint64_t n : header.grid.dimensions) {
    constexpr std::uint64_t kMost = (std::uint64_t{1} << PageGrid::kMaxDepth) + 1;
    if (n > kMost) fail("{}: expected at most {} samples along every axis, found {}", name, kMost, n);
  }
  return header;
}

void write_chunk(ByteWriter& out, const DirectoryChunk& chunk) {
  for (const std::uint64_t n : {chunk.first, chunk.offset, chunk.size, chunk.pages, chunk.copies})
    out.varint(n);
  out.number(chunk.checksum);
}

DirectoryChunk read_chunk(ByteReader& in) {
  DirectoryChunk chunk;
  for (std::uint64_t* n : {&chunk.first, &chunk.offset, &chunk.size, &chunk.pages, &chunk.copies})
    *n = in.varint();
  chunk.checksum = in.number<std::uint32_t>();
  return chunk;
}

void check_chunks(const StoreRoot& root, const PageGrid& grid, std::uint64_t end, std::string_view name) {
  // The memory for all pages must not be more than the file has room to describe.
  const std::uint64_t parts = (grid.page_count() + DirectoryChunk::kPages - 1) / DirectoryChunk::kPages;
  if (root.chunks.size() < parts)
    fail("{}: expected {} parts or more of a directory, found {}", name, parts, root.chunks.size());
  const DirectoryChunk* before = nullptr;
  for (const DirectoryChunk& chunk : root.chunks) {
    if (chunk.first % DirectoryChunk::kPages != 0 || chunk.first >= std::uint64_t{2} << (3 * grid.top()))
      fail("{}: expected pages of its grid, found a directory of others", name);
    if (before != nullptr && before->first >= chunk.first)
      fail("{}: expected a directory in the order of pages, found another", name);
    if (chunk.offset > end || chunk.size > end - chunk.offset || chunk.pages > end || chunk.copies > end)
      fail("{}: expected a directory inside the file, found one beyond its end", name);
    before = &chunk;
  }
}

void write_remainders(ByteWriter& out, const RemainderTable& table) {
  out.varint(table.offset);
  for (const RemainderRecord& record : table.records) {
    out.varint(record.size);
    if (record.size > 0) out.number(record.checksum);
  }
}

RemainderTable read_remainders(ByteReader& in, const StoreHeader& header, std::uint64_t end,
                               std::string_view name) {
  RemainderTable table;
  if (!has_remainders(header.numbers.type)) return table;
  table.offset = in.varint();
  const std::uint64_t count = header.steps() * remainder_records(header.grid);
  if (count > in.rest().size())
    fail("{}: expected {} records of remainders, found room for fewer", name, count);
  std::uint64_t left = end - std::min(end, table.offset);
  for (std::uint64_t n = 0; n < count; ++n) {
    RemainderRecord record;
    record.size = in.varint();
    if (record.size > left) fail("{}: expected remainders inside the file, found some beyond its end", name);
    if (record.size > 0) record.checksum = in.number<std::uint32_t>();
    left -= record.size;
    table.records.push_back(record);
  }
  return table;
}

}  // namespace

template <class Word>
PageSummary summary(const PageShape& shape, const PageBounds<Word>& page) {
  PageSummary result;
  result.low = std::numeric_limits<Word>::max();
  for_each_own_place(shape, [&](std::size_t place) {
    result.low = std::min<std::uint32_t>(result.low, page.low[place]);
    result.high = std::max<std::uint32_t>(result.high, page.high[place]);
    result.error = std::max(result.error, page.errors[place]);
  });
  if (shape.complete) result.error = ErrorScale::kCodes - 1;
  const std::size_t count = result.part_count();
  if (count == 0) return result;
  if (shape.complete) {
    std::fill_n(result.part_errors.begin(), count, result.error);
    return result;
  }
  for_each_own_place(shape, [&](std::size_t place) {
    const std::uint32_t low = page.low[place], high = page.high[place];
    const std::uint8_t error = page.errors[place];
    if (low >= high || error == 0) return;
    for (std::size_t n = result.part(low + 1); n <= result.part(high); ++n)
      result.part_errors[n] = std::max(result.part_errors[n], error);
  });
  const int least = result.error - PageSummary::kSpan;
  for (std::uint8_t& error : result.part_errors) {
    if (error > 0) error = static_cast<std::uint8_t>(std::max<int>(error, least));
  }
  return result;
}

ADAMAS_INSTANTIATE_FUNCTION_FOR_WORDS(summary);

std::vector<std::byte> StorePrologue::serialise() const {
  std::vector<std::byte> bytes;
  ByteWriter out(bytes);
  out.bytes(std::as_bytes(std::span(kMagic)));
  out.number(kVersion);
  out.number(root.offset);
  out.number(root.size);
  out.number(crc32c(bytes));
  return bytes;
}

StorePrologue StorePrologue::parse(std::span<const std::byte> bytes, std::string_view name) {
  if (bytes.size() < kMagic.size() || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
    fail("{}: expected a store of adamas (\"adamas\" at its beginning), found something else", name);
  ByteReader in(bytes.subspan(kMagic.size()));
  StorePrologue prologue;
  const auto version = in.number<std::uint32_t>();
  prologue.root.offset = in.number<std::uint64_t>();
  prologue.root.size = in.number<std::uint64_t>();
  const auto checksum = in.number<std::uint32_t>();
  if (!in.good()) fail("{}: expected {} bytes or more, found {}", name, kBytes, bytes.size());
  if (version != kVersion) fail("{}: expected version {} of the format, found {}", name, kVersion, version);
  if (checksum != crc32c(bytes.first(kBytes - 4)))
    fail_as(ErrorKind::kDamaged, "{}: its first {} bytes are damaged", name, kBytes);
  return prologue;
}

std::vector<std::byte> StoreRoot::serialise() const {
  std::vector<std::byte> bytes;
  ByteWriter out(bytes);
  write_header(out, header);
  out.varint(before.offset);
  out.varint(before.size);
  out.varint(chunks.size());
  for (const DirectoryChunk& chunk : chunks) write_chunk(out, chunk);
  if (has_remainders(header.numbers.type)) write_remainders(out, remainders);
  out.number(crc32c(bytes));
  return bytes;
}

StoreRoot StoreRoot::parse(std::span<const std::byte> bytes, std::uint64_t root_offset,
                           std::string_view name) {
  constexpr std::size_t kChecksum = sizeof(std::uint32_t);
  std::uint32_t checksum = 0;
  if (bytes.size() >= kChecksum) std::memcpy(&checksum, bytes.last(kChecksum).data(), kChecksum);
  if (bytes.size() < kChecksum || checksum != crc32c(bytes.first(bytes.size() - kChecksum)))
    fail_as(ErrorKind::kDamaged, "{}: the {} bytes at its end, which say where everything lies, are damaged",
            name, bytes.size());
  ByteReader in(bytes.first(bytes.size() - kChecksum));
  StoreRoot root;
  root.header = read_header(in, name);
  const PageGrid grid(root.header.grid.dimensions);
  root.before.offset = in.varint();
  root.before.size = in.varint();
  const bool is_first = root.header.first_step == 0;
  if (is_first ? root.before != RootPlace{}
               : root.before.offset > root_offset || root.before.size > root_offset - root.before.offset)
    fail("{}: expected the steps before step {}, found none", name, root.header.first_step);
  constexpr std::size_t kLeastChunkBytes = 9;
  const std::uint64_t count = in.varint();
  if (count > in.rest().size() / kLeastChunkBytes)
    fail("{}: expected {} parts of a directory, found room for fewer", name, count);
  for (std::uint64_t n = 0; n < count; ++n) root.chunks.push_back(read_chunk(in));
  root.remainders = read_remainders(in, root.header, root_offset, name);
  if (!in.good() || !in.rest().empty()) fail("{}: expected a directory, found other bytes", name);
  check_chunks(root, grid, root_offset, name);
  return root;
}

namespace {

/// Writes four bits for each part, the first lowest: 0 where nothing is crossed, else 15 less the difference
/// between the page's greatest error and the part's.
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

/// Reads these bits. Returns false where an error is no code.
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
    // Numbers between those of two LODs belong to no page.
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
  /// Begins to read. `most` is the greatest number of entries.
  EntryReader(std::span<const std::byte> bytes, std::size_t word_bytes, std::uint64_t most)
      : in_(bytes), word_bytes_(word_bytes), most_(most) {}

  /// Takes the next entry; none where the bytes are not those of an entry, or a stretch of plain pages
  /// continues another.
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
  PageEntry plain_;  ///< the entry of the last stretch of plain pages
  std::uint64_t plain_left_ = 0;
  bool follows_plain_ = false;
};

/// Finds the offsets of the pages of a chunk: group by group, and in each group one step after another.
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
