#pragma once

#include <cstddef>
#include <cstdint>

#include "isosurface/storage/page_group.h"
#include "isosurface/storage/store_file.h"

namespace adamas::timevarying {

/// Says how much is read at a time of a series: with the bytes of a page at a step, those of its group at the
/// steps that follow, which lie behind them.
struct ReadAhead {
  std::uint64_t bytes = 0;   ///< of one read, a quarter more or less; 0: each page is read alone
  bool is_backward = false;  ///< the steps before are read instead
  std::size_t memory = 0;    ///< bytes for what was read and not asked for yet
  [[nodiscard]] bool is_on() const { return bytes > 0; }
  /// The length of a read at a place: slightly different for each, so that not all pages are read in the same
  /// frame when a series is played.
  [[nodiscard]] std::uint64_t length(std::uint64_t offset) const;
};

/// Lets a file read so, and the files that are made of it for other threads later. A file that is mapped
/// takes no notice.
void set_read_ahead(isosurface::StoreFile& file, const ReadAhead& ahead);

/// Finds what is read for the page at a place of a group: with it those of the `coded_with` steps before it,
/// as far as they go into one read; what lies before it at its step, if all of that does; and then what comes
/// next. Where steps are read backwards, what lies behind it at its step, and then what comes before. The
/// stretch ends where pages are in memory already, so that nothing is read twice.
isosurface::FileStretch stretch_to_read(const isosurface::PageGroup& group, std::size_t place,
                                        std::size_t coded_with, const ReadAhead& ahead,
                                        const isosurface::PageRuns& in_memory, std::uint64_t file_size);

}  // namespace adamas::timevarying
