#include "isosurface/storage/store_file_writer.h"

#include <ios>
#include <system_error>
#include <utility>

#include "core/base/assert.h"
#include "core/base/checksum.h"
#include "core/base/error.h"
#include "isosurface/storage/page_payload.h"

namespace adamas::isosurface {

StoreFileWriter::StoreFileWriter(const std::filesystem::path& path, std::string shown, const VolumeGrid& grid,
                                 std::uint32_t group_pages)
    : shown_(std::move(shown)),
      stream_(path, std::ios::binary | std::ios::out | std::ios::trunc),
      grid_(grid.dimensions),
      word_bytes_(sample_bytes(grid.type)),
      group_pages_(group_pages) {
  if (!stream_) fail("{}: cannot be written", shown_);
  write(std::vector<std::byte>(StorePrologue::kBytes));
}

StoreFileWriter::StoreFileWriter(const std::filesystem::path& path, const StoreFile& store)
    : shown_(store.name()),
      stream_(path, std::ios::binary | std::ios::in | std::ios::out),
      grid_(store.grid()),
      word_bytes_(sample_bytes(store.header().grid.type)),
      group_pages_(store.header().group_pages),
      at_(store.last_root().end()),
      before_(store.last_root()) {
  if (!stream_) fail("{}: cannot be written", shown_);
  // An unfinished block is removed first: if it were longer than the new one, its end would remain behind
  // that.
  std::error_code failed;
  std::filesystem::resize_file(path, at_, failed);
  if (failed) fail("{}: cannot be cut to {} bytes: {}", shown_, at_, failed.message());
  stream_.seekp(static_cast<std::streamoff>(at_));
}

void StoreFileWriter::write(std::span<const std::byte> bytes) {
  stream_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream_)
    fail_as(ErrorKind::kSpace, "{}: cannot write {} bytes more: is the disk full?", shown_, bytes.size());
  at_ += bytes.size();
}

void StoreFileWriter::begin_block() {
  if (!std::exchange(has_begun_, true) && before_.size > 0) write(std::as_bytes(std::span(kBlockMark)));
}

void StoreFileWriter::add_remainders(std::span<const std::byte> record) {
  ADAMAS_ASSERT(chunks_.empty());
  begin_block();
  if (remainders_.records.empty()) remainders_.offset = at_;
  remainders_.records.push_back({record.size(), crc32c(record)});
  write(record);
}

void StoreFileWriter::begin_chunk(std::uint64_t first) {
  begin_block();
  DirectoryChunk chunk;
  chunk.first = first;
  chunk.pages = at_;
  chunk.copies = copies_.size();
  chunks_.push_back(chunk);
}

void StoreFileWriter::end_chunk() {
  ADAMAS_ASSERT(entries_.size() % chunk_pages(grid_, chunks_.back().first).size() == 0);
  entry_bytes_.push_back(serialise_entries(entries_, word_bytes_));
  entries_.clear();
}

void StoreFileWriter::end_group() {
  if (group_.empty()) return;
  const std::size_t pages = group_numbers_.size(), steps = group_.size() / pages;
  for (std::size_t step = 0; step < steps; ++step) {
    for (std::size_t page = 0; page < pages; ++page) {
      const std::vector<std::byte>& payload = group_[page * steps + step];
      if (grid_.page(group_numbers_[page]).lod >= kCopiedLod)
        copies_.insert(copies_.end(), payload.begin(), payload.end());
      write(payload);
    }
  }
  group_.clear();
  group_numbers_.clear();
}

void StoreFileWriter::add_page(std::uint64_t number, std::span<const std::byte> payload,
                               const PageSummary& summary) {
  if (!group_numbers_.empty() && group_numbers_.back() / group_pages_ != number / group_pages_) end_group();
  const std::uint64_t first = number / DirectoryChunk::kPages * DirectoryChunk::kPages;
  if (chunks_.empty() || chunks_.back().first != first) {
    if (!chunks_.empty()) end_chunk();
    begin_chunk(first);
  }
  if (group_numbers_.empty() || group_numbers_.back() != number) group_numbers_.push_back(number);
  PageEntry entry{summary};
  ADAMAS_ASSERT(!payload.empty());
  if (is_plain(payload, summary)) payload = {};
  group_.emplace_back(payload.begin(), payload.end());
  if (!payload.empty()) {
    entry.size = static_cast<std::uint32_t>(payload.size());
    entry.checksum = crc32c(payload);
  }
  entries_.push_back(entry);
}

std::uint64_t StoreFileWriter::finish_block(const StoreHeader& header) {
  end_group();
  if (!chunks_.empty()) end_chunk();
  for (DirectoryChunk& chunk : chunks_) chunk.copies += at_;
  write(copies_);
  for (std::size_t n = 0; n < chunks_.size(); ++n) {
    chunks_[n].offset = at_;
    chunks_[n].size = entry_bytes_[n].size();
    chunks_[n].checksum = crc32c(entry_bytes_[n]);
    write(entry_bytes_[n]);
  }
  StoreRoot root{header, before_, std::move(chunks_), std::exchange(remainders_, {})};
  root.header.group_pages = group_pages_;
  const std::vector<std::byte> bytes = root.serialise();
  before_ = {at_, bytes.size()};
  write(bytes);
  write_prologue(before_);
  has_begun_ = false;
  chunks_.clear();
  entry_bytes_.clear();
  copies_.clear();
  return at_;
}

void StoreFileWriter::write_prologue(const RootPlace& root) {
  // Readers find the block when all of it is written, and the blocks before until then.
  stream_.flush();
  const std::vector<std::byte> prologue = StorePrologue{root}.serialise();
  stream_.seekp(0);
  stream_.write(reinterpret_cast<const char*>(prologue.data()),
                static_cast<std::streamsize>(prologue.size()));
  stream_.flush();
  stream_.seekp(static_cast<std::streamoff>(at_));
  if (!stream_) fail_as(ErrorKind::kSpace, "{}: cannot be written to its end: is the disk full?", shown_);
}

}  // namespace adamas::isosurface
