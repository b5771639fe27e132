#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "isosurface/storage/store_format.h"

namespace adamas {

/// How the bytes of pages come from the file: read one by one, or by a mapping that the system pages.
enum class Paging : std::uint8_t { kRead, kMap };

/// What was found where a page lies.
enum class PageState : std::uint8_t {
  kWhole,
  kCopied,   ///< damaged, and its second copy is whole
  kDamaged,  ///< or the part of the directory that tells of it is
};

/// A store that is open. Reads the directory in parts, as pages are asked for.
class StoreFile {
 public:
  /// Throws Error, which names the file, where it is missing, no store, cut off, or damaged in what says
  /// where things lie.
  explicit StoreFile(const std::filesystem::path& path, Paging paging = Paging::kRead);
  ~StoreFile();
  StoreFile(const StoreFile&) = delete;
  StoreFile& operator=(const StoreFile&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const StoreHeader& header() const { return root_.header; }
  [[nodiscard]] const PageGrid& grid() const { return grid_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// What the directory says of a page that the grid contains; nothing where that part of it is damaged.
  std::optional<PageEntry> entry(std::uint32_t step, const PageId& page);

  /// The page's bytes, valid until the next call; empty where both copies are damaged.
  struct Payload {
    PageState state;
    std::span<const std::byte> bytes;
  };
  Payload read(std::uint32_t step, const PageId& page);

  /// Reads all that is not pages, and throws Error at the first thing that is damaged: the directory's parts,
  /// bytes that belong to nothing.
  void check_directory();
  /// Whether a page's second copy, where it has one, is whole.
  bool copy_is_whole(const PageEntry& entry);

  /// Of pages and the directory.
  [[nodiscard]] std::uint64_t bytes_read() const { return bytes_read_; }

 private:
  using ChunkKey = std::pair<std::uint32_t, std::uint64_t>;
  struct Chunk {
    std::vector<std::uint64_t> numbers;
    std::vector<PageEntry> entries;  ///< empty: damaged
  };

  /// `size` bytes from `offset`, in the mapping or in buffer_. Bytes beyond the file's end are an Error.
  std::span<const std::byte> bytes_at(std::uint64_t offset, std::uint64_t size);
  const Chunk& chunk(const DirectoryChunk& chunk);

  std::string name_;
  int file_ = -1;
  std::uint64_t size_ = 0;
  const std::byte* mapping_ = nullptr;
  std::vector<std::byte> buffer_;
  StoreRoot root_;
  PageGrid grid_{{1, 1, 1}};
  std::map<ChunkKey, Chunk> chunks_;
  std::uint64_t bytes_read_ = 0;
};

}  // namespace adamas
