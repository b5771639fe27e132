#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "isosurface/volume/page.h"

namespace adamas {

/// The own points of pages as they are, in a file without a name, which goes with this.
template <class Word>
class ScratchPages {
 public:
  /// Keeps these parts of pages. Throws Error where the folder cannot hold a file.
  ScratchPages(const std::filesystem::path& folder, const PageGrid& grid, PageParts parts = PageParts::kAll);
  ~ScratchPages();
  ScratchPages(const ScratchPages&) = delete;
  ScratchPages& operator=(const ScratchPages&) = delete;

  /// Each page once. Throws Error where the disk is full.
  void put(const PageId& id, const Page<Word>& page);
  /// Fills parts of the own points of a page that was put; `values` is null where they are not wanted.
  void get(const PageId& id, PageParts parts, PageSamples<Word>& samples, PageBounds<Word>* values);

 private:
  std::uint64_t& offset(const PageId& id);

  [[nodiscard]] std::size_t point_bytes() const {
    return has_part(parts_, PageParts::kBounds) ? 3 * sizeof(Word) + 1 : sizeof(Word);
  }

  PageGrid grid_;
  PageParts parts_;
  std::filesystem::path folder_;
  int file_ = -1;
  std::uint64_t size_ = 0;
  std::vector<std::vector<std::uint64_t>> offsets_;  ///< by LOD and block
  std::vector<std::byte> buffer_;
};

extern template class ScratchPages<std::uint8_t>;
extern template class ScratchPages<std::uint16_t>;
extern template class ScratchPages<std::uint32_t>;

}  // namespace adamas
