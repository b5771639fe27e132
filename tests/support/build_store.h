#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "timevarying/series_builder.h"

namespace adamas::test {

/// Makes a store of one step from a volume. Messages call the file `shown`.
inline isosurface::StoreFigures build_store(const std::filesystem::path& path, const std::string& shown,
                                            const VolumeGrid& grid, const isosurface::PlaneSource& planes,
                                            const isosurface::StoreOptions& options) {
  return timevarying::build_series(path, shown, {grid, {0}, [&](std::uint32_t) { return planes; }}, options);
}

}  // namespace adamas::test
