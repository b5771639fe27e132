#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "isosurface/storage/store_file.h"

namespace adamas::isosurface {

/// Writes a store, block after block, page after page. A new file is no store before the first block is
/// finished. Readers do not see a block before it is finished, even if that never happens.
class StoreFileWriter {
 public:
  /// Begins a new file with blocks of this grid. Throws Error where it cannot be written; messages name
  /// `shown`, the file's final name. `group_pages` is that of StoreHeader.
  StoreFileWriter(const std::filesystem::path& path, std::string shown, const VolumeGrid& grid,
                  std::uint32_t group_pages = 1);
  /// Opens a store to add blocks behind its last one, in groups of the same size.
  StoreFileWriter(const std::filesystem::path& path, const StoreFile& store);

  /// Adds a record of remainders of numbers. All records of a block are added before its pages, step by step.
  void add_remainders(std::span<const std::byte> record);
  /// Adds a page at a step. All pages of a block that PageGrid::contains are added, in ascending order of
  /// number, then step.
  void add_page(std::uint64_t number, std::span<const std::byte> payload, const PageSummary& summary);
  /// Writes everything of the block except pages, and returns the file's size. `header` has the bytes and
  /// tables, which are known now; its size of groups is not used.
  std::uint64_t finish_block(const StoreHeader& header);

 private:
  void write(std::span<const std::byte> bytes);
  /// Marks the beginning of a block that is added to others.
  void begin_block();
  /// Writes the pages of a group, step by step.
  void end_group();
  void begin_chunk(std::uint64_t first);
  void end_chunk();
  void write_prologue(const RootPlace& root);

  std::string shown_;
  std::fstream stream_;
  PageGrid grid_;
  std::size_t word_bytes_;
  std::uint32_t group_pages_;
  std::uint64_t at_ = 0;
  RootPlace before_;        ///< the root of the last finished block
  bool has_begun_ = false;  ///< whether something of the block has been written
  RemainderTable remainders_;
  std::vector<DirectoryChunk> chunks_;        ///< chunks of the block; the members below are of the block too
  std::vector<std::uint64_t> group_numbers_;  ///< numbers of the pages of the last group
  std::vector<std::vector<std::byte>> group_;        ///< bytes of these pages, of each page for all steps
  std::vector<PageEntry> entries_;                   ///< entries of the last chunk
  std::vector<std::vector<std::byte>> entry_bytes_;  ///< entries of the chunks before, as bytes
  std::vector<std::byte> copies_;
};

}  // namespace adamas::isosurface
