#pragma once

#include <cstddef>
#include <cstdint>

#include "isosurface/storage/page_group.h"
#include "isosurface/storage/store_file.h"

namespace adamas::timevarying {

/// How much is read at a time from a series: together with a page at a step, the pages of its group at the
/// following steps, which lie behind it in the file.
struct ReadAhead {
  std::uint64_t bytes = 0;   ///< size of one read, give or take a quarter; 0: each page is read alone
  bool is_backward = false;  ///< whether the steps before are read instead
  std::size_t memory = 0;    ///< bytes for data that were read but not yet requested
  [[nodiscard]] bool is_on() const { return bytes > 0; }
  /// The length of a read at an offset. It differs slightly between offsets, so that not all pages are read
  /// in the same frame when a series is played.
  [[nodiscard]] std::uint64_t length(std::uint64_t offset) const;
};

/// Sets how a file, and the copies of it that are opened later for other threads, reads ahead. It has no
/// effect on a mapped file.
void set_read_ahead(isosurface::StoreFile& file, const ReadAhead& ahead);

/// Finds what is read together with the page at a place of a group: first the `coded_with` steps before it,
/// as far as they fit into one read; then the pages before it at its step, if all of them fit; and then the
/// following pages. If steps are read backwards: the pages behind it at its step, and then those before. The
/// stretch ends where pages are in memory already, so that nothing is read twice.
isosurface::FileStretch stretch_to_read(const isosurface::PageGroup& group, std::size_t place,
                                        std::size_t coded_with, const ReadAhead& ahead,
                                        const isosurface::PageRuns& in_memory, std::uint64_t file_size);

}  // namespace adamas::timevarying
