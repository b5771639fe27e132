#pragma once

#include <cstddef>

#include "adamas/progress.h"
#include "adamas/volume_store.h"
#include "isosurface/storage/store_file.h"

namespace adamas::timevarying {

/// Reads every byte of a store and checks checksums, that all pages can be decoded, and that no diamond has a
/// greater error or range than its parents. Throws Error if the directory is damaged.
VerifiedStore verify_store(isosurface::StoreFile& file, std::size_t memory, Progress& progress);

}  // namespace adamas::timevarying
