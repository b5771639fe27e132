#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "adamas/progress.h"
#include "isosurface/storage/store_file.h"

namespace adamas::timevarying {

/// A problem of pages.
struct PageProblem {
  std::string what;                  ///< "the page of level 0 at 1, 1, 1 is damaged"
  std::vector<std::uint32_t> steps;  ///< steps at which it occurs, ascending
};

/// The result of a check of a store.
struct VerifiedStore {
  std::uint64_t pages = 0;
  std::uint64_t bad_pages = 0;           ///< damaged, both copies where there are two, or predicted from such
  std::uint64_t bad_copies = 0;          ///< pages one of whose two copies is damaged
  std::vector<std::uint32_t> bad_steps;  ///< that have bad pages, ascending
  std::vector<PageProblem> problems;     ///< the first problems
  std::uint64_t untold = 0;              ///< pages at steps that have further problems
};

/// Reads every byte of a store: checksums, that all pages can be decoded, and that no diamond has a greater
/// error or range than those that it comes from. Throws Error where the directory is damaged.
VerifiedStore verify_store(isosurface::StoreFile& file, std::size_t memory, Progress& progress);

}  // namespace adamas::timevarying
