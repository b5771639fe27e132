#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "adamas/progress.h"
#include "adamas/volume_store.h"
#include "isosurface/storage/store_file.h"

namespace adamas::timevarying {

/// Opens a store. Throws Error as VolumeStore::open does.
std::unique_ptr<isosurface::StoreFile> open_store_file(const std::filesystem::path& path,
                                                       const OpenOptions& options);

/// Returns the step that is asked for; the first one where none is, with a note where there are several.
/// Throws Error (kUsage) where the store has no such step.
std::uint32_t wanted_step(const std::optional<std::uint64_t>& step, const isosurface::StoreFile& file,
                          Progress& progress);

}  // namespace adamas::timevarying
