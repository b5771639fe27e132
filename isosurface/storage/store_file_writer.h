#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "isosurface/storage/store_format.h"

namespace adamas {

/// Writes a store, page after page. The file is none until finish().
class StoreFileWriter {
 public:
  /// Throws Error where the file cannot be written; messages name `shown`, the file's final name.
  StoreFileWriter(const std::filesystem::path& path, std::string shown, const StoreHeader& header);

  /// Pages that PageGrid::contains, every one, in ascending order of step and number.
  void add_page(std::uint32_t step, std::uint64_t number, std::span<const std::byte> payload,
                const PageSummary& summary);
  /// With the bytes and tables that are known now. Returns the file's size.
  std::uint64_t finish(StoreHeader header);

 private:
  void write(std::span<const std::byte> bytes);
  void begin_chunk(std::uint32_t step, std::uint64_t first);
  void end_chunk();

  std::string shown_;
  std::ofstream stream_;
  PageGrid grid_;
  std::size_t word_bytes_;
  std::uint64_t at_ = 0;
  std::vector<DirectoryChunk> chunks_;
  std::vector<PageEntry> entries_;                   ///< of the last chunk
  std::vector<std::vector<std::byte>> entry_bytes_;  ///< of the chunks before
  std::vector<std::byte> copies_;
};

}  // namespace adamas
