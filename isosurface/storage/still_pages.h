#pragma once

#include <cstdint>
#include <unordered_map>

#include "isosurface/storage/store_file.h"

namespace adamas {

/// Which pages of a series are the same at several steps, by what the directory says of them: nothing is read
/// but parts of that, and nothing is decoded. Pages that are the same may not be known to be, those of whole
/// steps (kWholeSteps) among them.
class StillPages {
 public:
  /// The file must outlive this.
  explicit StillPages(StoreFile& file) : file_(file) {}

  /// Whether the samples and bounds of a page are the same at all steps from one to another, in either order.
  /// `reads`: parts of the directory may be read; a page is not known to be the same without them.
  bool is_still(const PageId& page, std::uint32_t from, std::uint32_t to, bool reads);

 private:
  /// Since the step before.
  bool is_still_at(std::uint32_t step, const PageId& page, bool reads);
  bool says_directory(std::uint32_t step, const PageId& page, bool reads);

  StoreFile& file_;
  std::uint32_t step_ = 0;
  std::unordered_map<std::uint64_t, bool> known_;  ///< by page number; of step_
};

}  // namespace adamas
