#include "isosurface/storage/store_file_writer.h"

#include <utility>

#include "core/base/assert.h"
#include "core/base/checksum.h"
#include "core/base/error.h"

namespace adamas {

StoreFileWriter::StoreFileWriter(const std::filesystem::path& path, std::string shown,
                                 const StoreHeader& header)
    : shown_(std::move(shown)),
      stream_(path, std::ios::binary | std::ios::trunc),
      grid_(header.grid.dimensions),
      word_bytes_(sample_bytes(header.grid.type)) {
  if (!stream_) fail("{}: cannot be written", shown_);
  write(std::vector<std::byte>(StorePrologue::kBytes));
}

void StoreFileWriter::write(std::span<const std::byte> bytes) {
  stream_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream_) fail("{}: cannot write {} bytes more: is the disk full?", shown_, bytes.size());
  at_ += bytes.size();
}

void StoreFileWriter::begin_chunk(std::uint32_t step, std::uint64_t first) {
  DirectoryChunk chunk;
  chunk.step = step;
  chunk.first = first;
  chunk.pages = at_;
  chunk.copies = copies_.size();
  chunks_.push_back(chunk);
}

void StoreFileWriter::end_chunk() {
  ADAMAS_ASSERT(entries_.size() == chunk_pages(grid_, chunks_.back().first).size());
  entry_bytes_.push_back(serialise_entries(entries_, word_bytes_));
  entries_.clear();
}

void StoreFileWriter::add_page(std::uint32_t step, std::uint64_t number, std::span<const std::byte> payload,
                               const PageSummary& summary) {
  const std::uint64_t first = number / DirectoryChunk::kPages * DirectoryChunk::kPages;
  if (chunks_.empty() || chunks_.back().step != step || chunks_.back().first != first) {
    if (!chunks_.empty()) end_chunk();
    begin_chunk(step, first);
  }
  PageEntry entry{summary};
  entry.size = static_cast<std::uint32_t>(payload.size());
  entry.checksum = crc32c(payload);
  entries_.push_back(entry);
  if (grid_.page(number).lod >= kCopiedLod) copies_.insert(copies_.end(), payload.begin(), payload.end());
  write(payload);
}

std::uint64_t StoreFileWriter::finish(StoreHeader header) {
  if (!chunks_.empty()) end_chunk();
  for (DirectoryChunk& chunk : chunks_) chunk.copies += at_;
  write(copies_);
  for (std::size_t n = 0; n < chunks_.size(); ++n) {
    chunks_[n].offset = at_;
    chunks_[n].size = entry_bytes_[n].size();
    chunks_[n].checksum = crc32c(entry_bytes_[n]);
    write(entry_bytes_[n]);
  }
  StorePrologue prologue;
  prologue.root_offset = at_;
  const std::vector<std::byte> root = StoreRoot{std::move(header), chunks_}.serialise();
  prologue.root_size = root.size();
  write(root);
  const std::uint64_t size = at_;
  stream_.seekp(0);
  write(prologue.serialise());
  stream_.close();
  if (!stream_) fail("{}: cannot be written to its end: is the disk full?", shown_);
  return size;
}

}  // namespace adamas
