#pragma once

#include <cstddef>
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

/// Gives the library itself the file of an open store, and the number of bytes that decoded pages may take.
struct StoreAccess {
  static isosurface::StoreFile& file(VolumeStore& store);
  static std::size_t memory(VolumeStore& store);
};

/// Returns the requested step, or the first one if none is requested, with a note if there are several.
/// Throws Error (kUsage) if the store has no such step.
std::uint32_t wanted_step(const std::optional<std::uint64_t>& step, const isosurface::StoreFile& file,
                          Progress& progress);

}  // namespace adamas::timevarying
