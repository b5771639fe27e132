#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/base/unnamed_file.h"
#include "isosurface/storage/page_cache.h"

namespace adamas::isosurface {

/// The own points of pages, uncompressed in an unnamed file, which the system deletes when this object goes;
/// and a cache of those that are read.
template <class Word>
class ScratchPages : public PageCache<Word> {
 public:
  /// Makes the file. `parts`: the parts of pages that are stored, of which at most `memory` bytes are in
  /// memory. Throws Error where the folder cannot hold a file.
  ScratchPages(const std::filesystem::path& folder, const PageGrid& grid, std::size_t memory,
               PageParts parts = PageParts::kAll);

  /// Writes a page to the file: each page once, before pages are requested. Throws Error where the disk is
  /// full.
  void put(const PageId& id, const Page<Word>& page);

 private:
  /// Reads the missing parts. Throws Error where the file cannot be read.
  bool load(const PageToLoad<Word>& page) override;
  std::uint64_t& offset(const PageId& id);

  [[nodiscard]] std::size_t point_bytes() const {
    return has_part(parts_, PageParts::kBounds) ? 3 * sizeof(Word) + 1 : sizeof(Word);
  }

  PageParts parts_;
  ScratchFile file_;
  std::uint64_t size_ = 0;
  std::vector<std::vector<std::uint64_t>> offsets_;  ///< indexed by LOD and block
  std::vector<std::byte> buffer_;
};

}  // namespace adamas::isosurface
