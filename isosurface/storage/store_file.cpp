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
#include "isosurface/storage/number_remainders.h"
#include "isosurface/storage/page_payload.h"

namespace adamas::isosurface {

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
    last_root_ = prologue.root;
    if (last_root_.offset > size_ || last_root_.size > size_ - last_root_.offset)
      fail("{}: expected {} bytes, found {}", name_, last_root_.end(), size_);
    if (!is_block_mark(last_root_.end(), unfinished_bytes()))
      fail("{}: expected {} bytes, found {}", name_, last_root_.end(), size_);
    read_blocks();
    grid_ = PageGrid(header().grid.dimensions);
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

bool StoreFile::is_block_mark(std::uint64_t offset, std::uint64_t most) {
  const auto mark = std::as_bytes(std::span(kBlockMark));
  const auto found = bytes_at(offset, std::min<std::uint64_t>(mark.size(), most));
  return std::equal(found.begin(), found.end(), mark.begin());
}

void StoreFile::read_blocks() {
  // Blocks are read from the last to the first one.
  for (RootPlace place = last_root_;;) {
    Block block{StoreRoot::parse(bytes_at(place.offset, place.size), place.offset, name_), place.size};
    const StoreHeader& header = block.root.header;
    if (!blocks_.empty()) {
      const StoreHeader& next = blocks_.back().root.header;
      if (header.grid != next.grid || header.numbers != next.numbers || header.gradients != next.gradients ||
          header.first_step + header.steps() != next.first_step || header.times.back() >= next.times.front())
        fail("{}: expected the steps before step {}, found others", name_, next.first_step);
    }
    place = block.root.before;
    blocks_.push_back(std::move(block));
    if (blocks_.back().root.header.first_step == 0) break;
  }
  std::reverse(blocks_.begin(), blocks_.end());
}

const StoreFile::Block& StoreFile::block_of(std::uint32_t step) const {
  ADAMAS_ASSERT(step < steps());
  const auto next =
      std::upper_bound(blocks_.begin(), blocks_.end(), step,
                       [](std::uint32_t s, const Block& block) { return s < block.root.header.first_step; });
  return *(next - 1);
}

std::vector<double> StoreFile::times() const {
  std::vector<double> times;
  for (const Block& block : blocks_) {
    const std::vector<double>& own = block.root.header.times;
    times.insert(times.end(), own.begin(), own.end());
  }
  return times;
}

StoreBytes StoreFile::bytes() const {
  StoreBytes all;
  for (const Block& block : blocks_) all += block.root.header.bytes;
  return all;
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
  other->blocks_ = blocks_;
  other->last_root_ = last_root_;
  other->grid_ = grid_;
  other->plan_ = plan_;
  other->runs_ = runs_;
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
    if (got == 0)
      fail_as(ErrorKind::kDamaged, "{}: expected {} bytes, found {}: it was cut off", name_, size_,
              offset + done);
    done += static_cast<std::size_t>(got);
  }
  return std::span<const std::byte>(buffer_).first(count);
}

StoreFile::ChunkKey StoreFile::key_of(std::uint32_t step, const PageId& page) const {
  return {block_of(step).root.header.first_step,
          grid_.number(page) / DirectoryChunk::kPages * DirectoryChunk::kPages};
}

const StoreFile::DirectoryPart& StoreFile::chunk(const StoreHeader& block, const DirectoryChunk& from) {
  const auto known = chunks_.find({block.first_step, from.first});
  if (known != chunks_.end()) return *known->second;
  auto part = std::make_shared<DirectoryPart>();
  part->key = {block.first_step, from.first};
  part->numbers = chunk_pages(grid_, from.first);
  const auto bytes = bytes_at(from.offset, from.size);
  if (crc32c(bytes) == from.checksum) {
    if (auto entries = parse_entries(grid_, from, block, bytes)) part->entries = std::move(*entries);
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

std::optional<StoreFile::EntryPlace> StoreFile::entry_place(std::uint32_t step, const PageId& page) {
  const std::uint64_t number = grid_.number(page);
  const Block& block = block_of(step);
  const StoreHeader& header = block.root.header;
  const ChunkKey key = key_of(step, page);
  const auto known = chunks_.find(key);
  const DirectoryPart* found = known != chunks_.end() ? known->second.get() : nullptr;
  if (found == nullptr) {
    const std::vector<DirectoryChunk>& chunks = block.root.chunks;
    const auto from =
        std::lower_bound(chunks.begin(), chunks.end(), key.second,
                         [](const DirectoryChunk& c, std::uint64_t at) { return c.first < at; });
    if (from == chunks.end() || from->first != key.second) return {};
    found = &chunk(header, *from);
  }
  const auto at = std::lower_bound(found->numbers.begin(), found->numbers.end(), number);
  if (found->entries.empty() || at == found->numbers.end() || *at != number) return {};
  EntryPlace place;
  place.part = found;
  place.page = static_cast<std::size_t>(at - found->numbers.begin());
  place.step = step - header.first_step;
  place.block = &header;
  return place;
}

std::size_t StoreFile::EntryPlace::group_begin() const {
  const std::uint64_t number = part->numbers[page];
  const auto begin = std::ranges::lower_bound(part->numbers, number - number % block->group_pages);
  return static_cast<std::size_t>(begin - part->numbers.begin());
}

PageGroup StoreFile::EntryPlace::group(std::size_t begin) const {
  const std::size_t steps = block->steps(), end = group_end(part->numbers, begin, block->group_pages);
  return {std::span(part->entries).subspan(begin * steps, (end - begin) * steps), steps};
}

std::optional<PageEntry> StoreFile::entry(std::uint32_t step, const PageId& page) {
  const std::optional<EntryPlace> place = entry_place(step, page);
  if (!place) return {};
  return place->entry();
}

std::span<const std::byte> StoreFile::page_bytes(const EntryPlace& place) {
  const PageEntry& page = place.entry();
  const bool is_ahead = mapping_ == nullptr && plan_ != nullptr;
  if (is_ahead) {
    if (buffer_.size() < page.size) buffer_.resize(page.size);
    const std::span<std::byte> known(buffer_.data(), page.size);
    if (runs_->copy(page.offset, known)) return known;
  }
  ++page_reads_;
  if (!is_ahead) return bytes_at(page.offset, page.size);
  const std::size_t first = place.group_begin();
  const PageGroup group = place.group(first);
  const std::size_t at = group.place(place.page - first, place.step);
  // If the step before was not read recently, the steps that this one may be coded with will be requested
  // too.
  std::size_t coded_with =
      std::min<std::size_t>(place.step, (place.block->first_step + place.step) % kWholeSteps);
  if (coded_with > 0) {
    const PageEntry& before = group[at - group.pages()];
    if (runs_->has(before.offset, before.size)) coded_with = 0;
  }
  const auto [begin, end] = plan_->stretch(group, at, coded_with, *runs_, size_);
  const auto bytes = bytes_at(begin, end - begin);
  runs_->put(begin, bytes, plan_->memory());
  return bytes.subspan(page.offset - begin, page.size);
}

StoreFile::Payload StoreFile::read(std::uint32_t step, const PageId& page) {
  const std::optional<EntryPlace> place = entry_place(step, page);
  if (!place) return {PageState::kDamaged, {}};
  const PageEntry& found = place->entry();
  if (found.size == 0) return {PageState::kWhole, plain_payload()};
  for (const std::uint64_t offset : {found.offset, found.copy}) {
    // A damaged directory may have any offset.
    if (offset == 0 || offset > size_ || found.size > size_ - offset) continue;
    const bool is_first = offset == found.offset;
    const auto bytes = is_first ? page_bytes(*place) : bytes_at(offset, found.size);
    if (crc32c(bytes) == found.checksum) return {is_first ? PageState::kWhole : PageState::kCopied, bytes};
  }
  return {PageState::kDamaged, {}};
}

bool StoreFile::copy_is_whole(const PageEntry& entry) {
  if (entry.copy == 0) return true;
  return entry.size <= size_ && entry.copy <= size_ - entry.size &&
         crc32c(bytes_at(entry.copy, entry.size)) == entry.checksum;
}

std::optional<std::span<const std::byte>> StoreFile::remainders(std::uint32_t step, std::uint64_t record) {
  const Block& block = block_of(step);
  const RemainderTable& table = block.root.remainders;
  const std::uint64_t last =
      (step - block.root.header.first_step) * remainder_records(block.root.header.grid) + record;
  ADAMAS_ASSERT(last < table.records.size());
  std::uint64_t offset = table.offset;
  for (std::uint64_t n = 0; n < last; ++n) offset += table.records[n].size;
  const RemainderRecord& wanted = table.records[last];
  const auto bytes = bytes_at(offset, wanted.size);
  if (wanted.size > 0 && crc32c(bytes) != wanted.checksum) return {};
  return bytes;
}

void StoreFile::check_directory() {
  std::uint64_t total = StorePrologue::kBytes;
  for (const Block& block : blocks_) {
    std::uint64_t entries = 0;
    for (const DirectoryChunk& from : block.root.chunks) {
      const DirectoryPart& found = chunk(block.root.header, from);
      if (found.entries.empty() && !found.numbers.empty())
        fail_as(ErrorKind::kDamaged, "{}: the part of the directory at {} is damaged", name_, from.offset);
      for (const PageEntry& entry : found.entries) total += entry.copy != 0 ? 2 * entry.size : entry.size;
      entries += found.entries.size();
      total += from.size;
    }
    const std::uint64_t wanted = grid_.page_count() * block.root.header.steps();
    if (entries != wanted) fail("{}: expected {} pages, found {}", name_, wanted, entries);
    for (const RemainderRecord& record : block.root.remainders.records) total += record.size;
    total += block.root_bytes;
    if (block.root.header.first_step == 0) continue;
    total += kBlockMark.size();
    const std::uint64_t begin = block.root.before.end();
    if (!is_block_mark(begin, size_ - begin))
      fail_as(ErrorKind::kDamaged, "{}: the beginning of its steps at {} is damaged", name_, begin);
  }
  if (total != last_root_.end())
    fail("{}: expected {} bytes by its directory, found {}", name_, total, last_root_.end());
}

}  // namespace adamas::isosurface
