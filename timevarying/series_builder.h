#pragma once

#include <filesystem>
#include <string>

#include "adamas/progress.h"
#include "adamas/volume_store.h"
#include "isosurface/storage/store_options.h"
#include "timevarying/store_lock.h"

namespace adamas::timevarying {

/// Preprocesses the steps of a series, orders them in pages and compresses these into a store at `path`, as
/// BlockBuilder does with one volume; pages may be coded with those of the steps before (TimeCodec).
isosurface::StoreFigures build_series(const std::filesystem::path& path, const std::string& shown,
                                      const SeriesSource& series, const isosurface::StoreOptions& options,
                                      Progress& progress = SilentProgress::instance());

/// Appends steps, whose times are after those of the locked store. They get the store's coding, unless they
/// are to be plain, its size of groups, and gradients if it has some. A process that opens the file during
/// this, or after this process was killed, finds all steps of the blocks that are complete.
isosurface::StoreFigures append_series(const StoreLock& store, const SeriesSource& series,
                                       isosurface::StoreOptions options,
                                       Progress& progress = SilentProgress::instance());

}  // namespace adamas::timevarying
