#include "isosurface/storage/store_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/base/assert.h"
#include "core/base/checksum.h"
#include "core/base/error.h"
#include "isosurface/storage/page_payload.h"

namespace adamas {

StoreFile::StoreFile(const std::filesystem::path& path, Paging paging) : name_(path.string()) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown))
    fail("{}: expected a store of adamas, found {}", name_,
         std::filesystem::exists(path, unknown) ? "no regular file" : "no such file");
  file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (file_ < 0 || fstat(file_, &status) != 0) {
    const int reason = errno;
    if (file_ >= 0) close(file_);
    fail("{}: cannot be read: {}", name_, std::strerror(reason));
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
  try {
    if (paging == Paging::kMap && size_ > 0) map();
    const StorePrologue prologue =
        StorePrologue::parse(bytes_at(0, std::min<std::uint64_t>(size_, StorePrologue::kBytes)), name_);
    if (prologue.root_offset > size_ || prologue.root_size != size_ - prologue.root_offset)
      fail("{}: expected {} bytes, found {}", name_, prologue.root_offset + prologue.root_size, size_);
    root_ = StoreRoot::parse(bytes_at(prologue.root_offset, prologue.root_size), prologue.root_offset, name_);
    grid_ = PageGrid(root_.header.grid.dimensions);
  } catch (...) {
    if (mapping_ != nullptr) munmap(const_cast<std::byte*>(mapping_), size_);
    close(file_);
    throw;
  }
}

StoreFile::~StoreFile() {
  if (mapping_ != nullptr) munmap(const_cast<std::byte*>(mapping_), size_);
  if (file_ >= 0) close(file_);
}

void StoreFile::map() {
  void* mapping = mmap(nullptr, size_, PROT_READ, MAP_SHARED, file_, 0);
  if (mapping == MAP_FAILED) fail("{}: cannot be mapped: {}", name_, std::strerror(errno));
  mapping_ = static_cast<const std::byte*>(mapping);
}

std::unique_ptr<StoreFile> StoreFile::for_another_thread() const {
  std::unique_ptr<StoreFile> other(new StoreFile);
  other->name_ = name_;
  other->size_ = size_;
  other->root_ = root_;
  other->grid_ = grid_;
  other->file_ = fcntl(file_, F_DUPFD_CLOEXEC, 0);
  if (other->file_ < 0) fail("{}: cannot be opened again: {}", name_, std::strerror(errno));
  if (mapping_ != nullptr) other->map();
  return other;
}

std::span<const std::byte> StoreFile::bytes_at(std::uint64_t offset, std::uint64_t size) {
  if (offset > size_ || size > size_ - offset)
    fail("{}: expected {} bytes at {}, found {} in all", name_, size, offset, size_);
  bytes_read_ += size;
  const auto count = static_cast<std::size_t>(size);
  if (mapping_ != nullptr) return {mapping_ + offset, count};
  if (buffer_.size() < count) buffer_.resize(count);
  for (std::size_t done = 0; done < count;) {
    const ssize_t got = pread(file_, buffer_.data() + done, count - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("{}: cannot be read at {}: {}", name_, offset + done, std::strerror(errno));
    if (got == 0) fail("{}: expected {} bytes, found {}: it was cut off", name_, size_, offset + done);
    done += static_cast<std::size_t>(got);
  }
  return std::span<const std::byte>(buffer_).first(count);
}

StoreFile::ChunkKey StoreFile::key_of(std::uint32_t step, const PageId& page) const {
  return {step, grid_.number(page) / DirectoryChunk::kPages * DirectoryChunk::kPages};
}

const StoreFile::DirectoryPart& StoreFile::chunk(const DirectoryChunk& from) {
  const auto known = chunks_.find({from.step, from.first});
  if (known != chunks_.end()) return *known->second;
  auto part = std::make_shared<DirectoryPart>();
  part->key = {from.step, from.first};
  part->numbers = chunk_pages(grid_, from.first);
  const auto bytes = bytes_at(from.offset, from.size);
  if (crc32c(bytes) == from.checksum) {
    if (auto entries = parse_entries(grid_, from, bytes, sample_bytes(root_.header.grid.type)))
      part->entries = std::move(*entries);
  }
  return *chunks_.emplace(part->key, part).first->second;
}

std::shared_ptr<const StoreFile::DirectoryPart> StoreFile::directory_part(std::uint32_t step,
                                                                          const PageId& page) {
  static_cast<void>(entry(step, page));
  const auto found = chunks_.find(key_of(step, page));
  return found == chunks_.end() ? nullptr : found->second;
}

void StoreFile::take_over(std::shared_ptr<const DirectoryPart> part) {
  chunks_.emplace(part->key, std::move(part));
}

std::optional<PageEntry> StoreFile::entry(std::uint32_t step, const PageId& page) {
  const std::uint64_t number = grid_.number(page);
  const ChunkKey key = key_of(step, page);
  const auto known = chunks_.find(key);
  const DirectoryPart* found = known != chunks_.end() ? known->second.get() : nullptr;
  if (found == nullptr) {
    const auto from = std::lower_bound(root_.chunks.begin(), root_.chunks.end(), key,
                                       [](const DirectoryChunk& c, const ChunkKey& k) {
                                         return ChunkKey{c.step, c.first} < k;
                                       });
    if (from == root_.chunks.end() || ChunkKey{from->step, from->first} != key) return {};
    found = &chunk(*from);
  }
  const auto at = std::lower_bound(found->numbers.begin(), found->numbers.end(), number);
  if (found->entries.empty() || at == found->numbers.end() || *at != number) return {};
  return found->entries[static_cast<std::size_t>(at - found->numbers.begin())];
}

StoreFile::Payload StoreFile::read(std::uint32_t step, const PageId& page) {
  const std::optional<PageEntry> found = entry(step, page);
  if (!found) return {PageState::kDamaged, {}};
  if (found->size == 0) return {PageState::kWhole, plain_payload()};
  for (const std::uint64_t offset : {found->offset, found->copy}) {
    // A damaged directory may say that the page lies anywhere.
    if (offset == 0 || offset > size_ || found->size > size_ - offset) continue;
    const auto bytes = bytes_at(offset, found->size);
    if (crc32c(bytes) == found->checksum)
      return {offset == found->offset ? PageState::kWhole : PageState::kCopied, bytes};
  }
  return {PageState::kDamaged, {}};
}

bool StoreFile::copy_is_whole(const PageEntry& entry) {
  if (entry.copy == 0) return true;
  return entry.size <= size_ && entry.copy <= size_ - entry.size &&
         crc32c(bytes_at(entry.copy, entry.size)) == entry.checksum;
}

void StoreFile::check_directory() {
  std::uint64_t pages = 0, copies = 0, entries = 0, chunks = 0;
  for (const DirectoryChunk& from : root_.chunks) {
    const DirectoryPart& found = chunk(from);
    if (found.entries.empty() && !found.numbers.empty())
      fail("{}: the part of the directory at {} is damaged", name_, from.offset);
    for (const PageEntry& entry : found.entries) {
      pages += entry.size;
      copies += entry.copy != 0 ? entry.size : 0;
    }
    entries += found.entries.size();
    chunks += from.size;
  }
  if (entries != grid_.page_count() * root_.header.steps)
    fail("{}: expected {} pages, found {}", name_, grid_.page_count() * root_.header.steps, entries);
  const std::uint64_t root = root_.serialise().size();
  const std::uint64_t total = StorePrologue::kBytes + pages + copies + chunks + root;
  if (total != size_) fail("{}: expected {} bytes by its directory, found {}", name_, total, size_);
}

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
  ADAMAS_ASSERT(!payload.empty());
  if (is_plain(payload, summary)) {
    entries_.push_back(entry);
    return;
  }
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
