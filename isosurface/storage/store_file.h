#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "isosurface/storage/page_group.h"
#include "isosurface/storage/page_runs.h"
#include "isosurface/storage/store_format.h"

namespace adamas::isosurface {

/// The way in which bytes of pages are read: one by one, or by a memory mapping that the system pages.
enum class Paging : std::uint8_t { kRead, kMap };

enum class PageState : std::uint8_t {
  kWhole,
  kCopied,   ///< the page is damaged, and its second copy is whole
  kDamaged,  ///< neither copy is whole, or the part of the directory that describes the page is damaged
};

/// An open store. It reads the directory in parts, as pages are requested.
class StoreFile {
 public:
  /// Opens a store. Throws Error, which names the file, where it is missing, no store, cut off, or damaged in
  /// its root or header.
  explicit StoreFile(const std::filesystem::path& path, Paging paging = Paging::kRead);
  ~StoreFile();
  StoreFile(const StoreFile&) = delete;
  StoreFile& operator=(const StoreFile&) = delete;
  /// Opens the same file, in the state in which it was opened, for another thread. Throws Error where the
  /// system allows no more files.
  [[nodiscard]] std::unique_ptr<StoreFile> for_another_thread() const;

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Returns the header of the first block. All blocks have its grid, and gradients if it has.
  [[nodiscard]] const StoreHeader& header() const { return blocks_.front().root.header; }
  [[nodiscard]] const StoreHeader& header(std::uint32_t step) const { return block_of(step).root.header; }
  [[nodiscard]] std::uint32_t steps() const {
    return blocks_.back().root.header.first_step + blocks_.back().root.header.steps();
  }
  [[nodiscard]] std::size_t blocks() const { return blocks_.size(); }
  /// Returns the time of each step.
  [[nodiscard]] std::vector<double> times() const;
  /// Returns the bytes of all blocks together.
  [[nodiscard]] StoreBytes bytes() const;
  /// Returns the number of bytes behind the last block, which belong to a block that was never finished.
  [[nodiscard]] std::uint64_t unfinished_bytes() const { return size_ - last_root_.end(); }
  [[nodiscard]] RootPlace last_root() const { return last_root_; }
  [[nodiscard]] const PageGrid& grid() const { return grid_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Returns the directory entry of a page that the grid contains; none where that part of the directory is
  /// damaged.
  std::optional<PageEntry> entry(std::uint32_t step, const PageId& page);

  /// Returns whether the part of the directory that describes a page is in memory, so that entry() reads
  /// nothing.
  [[nodiscard]] bool has_entry(std::uint32_t step, const PageId& page) const {
    return chunks_.contains(key_of(step, page));
  }
  /// A part of the directory, which files of the same store in several threads may share.
  struct DirectoryPart;
  /// Returns the part of the directory that describes a page; null where there is none.
  std::shared_ptr<const DirectoryPart> directory_part(std::uint32_t step, const PageId& page);
  void take_over(std::shared_ptr<const DirectoryPart> part);

  /// A page's bytes, valid until the next call; empty where both copies are damaged.
  struct Payload {
    PageState state;
    std::span<const std::byte> bytes;
  };
  Payload read(std::uint32_t step, const PageId& page);
  /// Sets a plan by which read() reads more than a page at a time, also for files for other threads that are
  /// made later; null: one page. It has no effect on a file that is mapped.
  void set_read_plan(std::shared_ptr<const ReadPlan> plan) { plan_ = std::move(plan); }

  /// Reads a record of remainders of a step, which has remainder_records(); none where it is damaged. The
  /// bytes are valid until the next call.
  std::optional<std::span<const std::byte>> remainders(std::uint32_t step, std::uint64_t record);

  /// Reads all bytes except those of pages and remainders, and throws Error at the first damage: in the
  /// directory's parts, or bytes that belong to nothing.
  void check_directory();
  /// Returns whether a page's second copy, if it has one, is whole.
  bool copy_is_whole(const PageEntry& entry);

  /// Returns the number of bytes of pages and the directory that were read.
  [[nodiscard]] std::uint64_t bytes_read() const { return bytes_read_; }
  /// Returns the number of times that the file was read for pages.
  [[nodiscard]] std::uint64_t page_reads() const { return page_reads_; }

 private:
  StoreFile() = default;
  void map();

  struct Block {
    StoreRoot root;
    std::uint64_t root_bytes = 0;
  };
  [[nodiscard]] const Block& block_of(std::uint32_t step) const;
  void read_blocks();
  /// Returns whether a block, or as much of one as `most` bytes hold, begins at an offset.
  bool is_block_mark(std::uint64_t offset, std::uint64_t most);

  using ChunkKey = std::pair<std::uint32_t, std::uint64_t>;  ///< the block's first step, the first page

  /// Returns `size` bytes from `offset`, in the mapping or in buffer_. Throws Error where they lie beyond the
  /// file's end.
  std::span<const std::byte> bytes_at(std::uint64_t offset, std::uint64_t size);
  [[nodiscard]] ChunkKey key_of(std::uint32_t step, const PageId& page) const;
  const DirectoryPart& chunk(const StoreHeader& block, const DirectoryChunk& chunk);
  /// A page at a step in a part of the directory.
  struct EntryPlace;
  /// Finds a page at a step; none where that part of the directory is damaged.
  std::optional<EntryPlace> entry_place(std::uint32_t step, const PageId& page);
  /// Reads the first copy of a page's bytes.
  std::span<const std::byte> page_bytes(const EntryPlace& place);

  std::string name_;
  int file_ = -1;
  std::uint64_t size_ = 0;
  const std::byte* mapping_ = nullptr;
  std::vector<std::byte> buffer_;
  std::vector<Block> blocks_;
  RootPlace last_root_;
  PageGrid grid_{{1, 1, 1}};
  std::map<ChunkKey, std::shared_ptr<const DirectoryPart>> chunks_;
  std::shared_ptr<const ReadPlan> plan_;  ///< null: each page is read alone
  std::shared_ptr<PageRuns> runs_ = std::make_shared<PageRuns>();
  std::uint64_t bytes_read_ = 0, page_reads_ = 0;
};

struct StoreFile::DirectoryPart {
  ChunkKey key;
  std::vector<std::uint64_t> numbers;
  std::vector<PageEntry> entries;  ///< empty if the part is damaged
};

struct StoreFile::EntryPlace {
  const DirectoryPart* part = nullptr;
  const StoreHeader* block = nullptr;
  std::size_t page = 0, step = 0;  ///< places among the part's pages and among the block's steps

  [[nodiscard]] const PageEntry& entry() const { return part->entries[page * block->steps() + step]; }
  /// Returns the place in the part of the first page of this page's group. group() returns the group that
  /// begins there.
  [[nodiscard]] std::size_t group_begin() const;
  [[nodiscard]] PageGroup group(std::size_t begin) const;
};

}  // namespace adamas::isosurface
