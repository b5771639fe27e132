#pragma once

#include <cstdint>
#include <memory>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/store_options.h"
#include "isosurface/storage/stored_pages.h"

namespace adamas::cli {

/// Opens a store, which no output may overwrite then.
std::unique_ptr<isosurface::StoreFile> open_store(const StoreInput& input, Session& session);

/// Returns the step that --step asks for; the first one where it does not, with a note where there are
/// several. Throws Error (kUsage) where the store has no such step.
std::uint32_t wanted_step(const StoreInput& input, const isosurface::StoreFile& file, Session& session);

/// Adds how many pages and bytes were read to the figures of a run.
void add_page_counts(const isosurface::PageCounts& counts, Figures& figures);

}  // namespace adamas::cli
