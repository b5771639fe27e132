#pragma once

#include <string>

#include "adamas/volume_store.h"
#include "isosurface/storage/store_file.h"
#include "isosurface/storage/store_options.h"

namespace adamas::timevarying {

/// Converts options. Throws Error (kUsage), with the names that options have on the command line, if they are
/// invalid or contradict each other.
isosurface::StoreOptions store_options(const BuildOptions& options);

/// Throws Error (kUsage) if options ask for what a store that steps are added to does not have. Messages call
/// the store `name`.
void check_options_of_store(const BuildOptions& options, const isosurface::StoreHeader& store,
                            const std::string& name);

/// Converts the figures of a store that was built.
BuildReport build_report(const isosurface::StoreFigures& figures);

}  // namespace adamas::timevarying
