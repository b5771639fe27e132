#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "isosurface/storage/page_runs.h"
#include "isosurface/storage/store_format.h"

namespace adamas::isosurface {

/// Pages that are interleaved in time in a block of steps (D 5.5): those whose numbers divided by
/// StoreHeader::group_pages are the same. The file has all of them at the first step, in ascending order,
/// then all at the second, and so on. A group of one page has the steps of that page side by side; the
/// greatest groups have whole steps of a directory chunk one after another.
class PageGroup {
 public:
  /// Makes a group. `entries` are those of each page for all steps, one page after another.
  PageGroup(std::span<const PageEntry> entries, std::size_t steps)
      : entries_(entries), steps_(steps), pages_(entries.size() / steps) {}

  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  [[nodiscard]] std::size_t pages() const { return pages_; }
  /// Returns the place of a page at a step among all pages of the group, in the order of the file.
  [[nodiscard]] std::size_t place(std::size_t page, std::size_t step) const { return step * pages_ + page; }
  [[nodiscard]] const PageEntry& operator[](std::size_t place) const {
    return entries_[place % pages_ * steps_ + place / pages_];
  }

 private:
  std::span<const PageEntry> entries_;
  std::size_t steps_, pages_;
};

/// Bytes of a file from `begin` to before `end`.
struct FileStretch {
  std::uint64_t begin = 0, end = 0;
};

/// Decides which bytes of a file are read with a page that is not in memory. Without a plan, a page is read
/// alone.
class ReadPlan {
 public:
  virtual ~ReadPlan() = default;

  /// Returns the stretch of the file that is read for the page at a place of its group; it contains this
  /// page's bytes. The page may be coded with those of the `coded_with` steps before it, which have not been
  /// read recently.
  [[nodiscard]] virtual FileStretch stretch(const PageGroup& group, std::size_t place, std::size_t coded_with,
                                            const PageRuns& in_memory, std::uint64_t file_size) const = 0;
  /// Returns the number of bytes that were read and not yet requested which may be kept.
  [[nodiscard]] virtual std::size_t memory() const = 0;
};

}  // namespace adamas::isosurface
