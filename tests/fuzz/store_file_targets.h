#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string_view>

#include "core/base/checksum.h"
#include "core/base/error.h"
#include "isosurface/storage/store_format.h"
#include "isosurface/volume/samples.h"
#include "tests/fuzz/require.h"
#include "timevarying/read_ahead.h"
#include "timevarying/step_pages.h"
#include "timevarying/verify_store.h"

namespace adamas::fuzz {

using namespace isosurface;
using namespace timevarying;

/// A file in memory.
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::byte> bytes) : file_(memfd_create("store", MFD_CLOEXEC)) {
    require(file_ >= 0, "no file in memory");
    require(::write(file_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()), "a short file");
  }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

/// Corrects the checksums of a store, from the last block to the first as far as their places can be read, so
/// that changed bytes are read and not refused.
class ChecksumRepair {
 public:
  explicit ChecksumRepair(std::vector<std::byte>& bytes) : bytes_(bytes) {
    if (bytes.size() < StorePrologue::kBytes) return;
    put(StorePrologue::kBytes - 4, crc32c(std::span(bytes).first(StorePrologue::kBytes - 4)));
    RootPlace place = StorePrologue::parse(std::span(bytes).first(StorePrologue::kBytes), "fuzz").root;
    // Where blocks form a circle the repair ends after some of them.
    for (int n = 0; n < 8 && place.size > 4 && has(place.offset, place.size); ++n) place = repair(place);
  }

 private:
  [[nodiscard]] bool has(std::uint64_t offset, std::uint64_t size) const {
    return offset <= bytes_.size() && size <= bytes_.size() - offset;
  }
  [[nodiscard]] std::span<std::byte> at(std::uint64_t offset, std::uint64_t size) const {
    return std::span(bytes_).subspan(offset, size);
  }
  void put(std::uint64_t offset, std::uint32_t checksum) const {
    std::memcpy(at(offset, 4).data(), &checksum, 4);
  }

  /// Corrects the checksums of a block. Returns the place of the root of the block before.
  RootPlace repair(const RootPlace& place) {
    const std::span<std::byte> bytes = at(place.offset, place.size);
    put(place.end() - 4, crc32c(bytes.first(bytes.size() - 4)));
    StoreRoot root = StoreRoot::parse(bytes, place.offset, "fuzz");
    const PageGrid grid(root.header.grid.dimensions);
    for (DirectoryChunk& chunk : root.chunks) {
      if (has(chunk.offset, chunk.size)) repair(grid, root.header, chunk);
    }
    std::uint64_t offset = root.remainders.offset;
    for (RemainderRecord& record : root.remainders.records) {
      record.checksum = crc32c(at(offset, record.size));
      offset += record.size;
    }
    // A checksum has the same number of bytes whatever its value.
    std::ranges::copy(root.serialise(), bytes.begin());
    return root.before;
  }

  void repair(const PageGrid& grid, const StoreHeader& block, DirectoryChunk& chunk) {
    const std::span<std::byte> bytes = at(chunk.offset, chunk.size);
    if (auto entries = parse_entries(grid, chunk, block, bytes)) {
      for (PageEntry& entry : *entries) {
        if (has(entry.offset, entry.size)) entry.checksum = crc32c(at(entry.offset, entry.size));
      }
      std::ranges::copy(serialise_entries(*entries, sample_bytes(block.grid.type)), bytes.begin());
    }
    chunk.checksum = crc32c(bytes);
  }

  std::vector<std::byte>& bytes_;
};

/// Returns all pages of an open store.
inline std::vector<PageId> pages_of(const StoreFile& file) {
  if (file.grid().page_count() * file.steps() > 300) fail("expected a small store, found a greater one");
  std::vector<PageId> pages;
  for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * file.grid().top()); ++number) {
    if ((std::bit_width(number) - 1) % 3 != 0) continue;
    if (const PageId id = file.grid().page(number); file.grid().contains(id)) pages.push_back(id);
  }
  return pages;
}

/// Requires that pages that are read ahead are those that are read alone, in either direction of steps.
inline void read_ahead(const std::string& path, std::uint64_t length, bool is_backward) {
  StoreFile alone(path), file(path);
  set_read_ahead(file, {length, is_backward, std::size_t{1} << 16});
  const std::vector<PageId> pages = pages_of(file);
  for (std::uint32_t n = 0; n < file.steps(); ++n) {
    const std::uint32_t step = is_backward ? file.steps() - 1 - n : n;
    for (const PageId& id : pages) {
      const StoreFile::Payload wanted = alone.read(step, id), found = file.read(step, id);
      require(wanted.state == found.state, "another state");
      require(std::ranges::equal(wanted.bytes, found.bytes), "other bytes");
    }
  }
}

/// Requires that pages are the same whether steps share a memory or not.
template <class Word>
void decode_all(StoreFile& file) {
  StepPages<Word> shared(file, std::size_t{1} << 20);
  const std::vector<PageId> pages = pages_of(file);
  const auto a = std::make_unique<Page<Word>>(), b = std::make_unique<Page<Word>>();
  for (std::uint32_t step = 0; step < file.steps(); ++step) {
    SeriesPages<Word> alone(file, step, 0);
    for (const PageId& id : pages) {
      const bool is_there = alone.copy(id, *a);
      require(shared.at(step).copy(id, *b) == is_there, "a page that is there and not");
      if (!is_there) continue;
      for_each_own_place(page_shape(file.grid(), id), [&](std::size_t n) {
        require(a->samples[n] == b->samples[n] && a->low[n] == b->low[n] && a->high[n] == b->high[n] &&
                    a->errors[n] == b->errors[n],
                "another page");
      });
    }
  }
}

/// The bytes are a whole store, the checksums of which are corrected.
inline void store_file(std::string_view given) {
  const auto bytes = std::as_bytes(std::span(given));
  std::vector<std::byte> repaired(bytes.begin(), bytes.end());
  const ChecksumRepair repair(repaired);
  const MemoryFile memory(repaired);
  StoreFile file(memory.path());
  std::uint32_t steps = 0;
  for (std::uint32_t step = 0; step < file.steps(); step += file.header(step).steps()) {
    require(file.header(step).first_step == step, "another step");
    steps += file.header(step).steps();
  }
  require(steps == file.steps() && std::ranges::is_sorted(file.times()), "other steps");
  for (const std::uint64_t length : {100u, 5000u}) {
    read_ahead(memory.path(), length, false);
    read_ahead(memory.path(), length, true);
  }
  with_sample_type(file.header().grid.type,
                   [&](auto sample) { decode_all<OrderedWord<decltype(sample)>>(file); });
  const VerifiedStore verified = verify_store(file, 0, SilentProgress::instance());
  if (verified.bad_pages + verified.bad_copies > 0) fail("expected sound pages, found others");
}

}  // namespace adamas::fuzz
