#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "core/io/grid_file.h"

namespace adamas::io {

/// The name of the format of folders that read_zarr() reads.
inline constexpr std::string_view kZarr = "OME-Zarr";

/// Whether a folder has metadata of Zarr.
bool is_zarr_folder(const std::filesystem::path& path);

/// Reads the finest level of an image of OME-Zarr 0.4, or one array of Zarr 2 along z, y and x, in this
/// process: chunks that are raw or compressed by zlib, gzip, Blosc or Zstandard; missing ones have the fill
/// value. Channels are arrays, by their labels. `time`: the number of a time; needed if there are several.
/// Throws Error, with the folder's name, if metadata or chunks are damaged or of another kind.
GridFile read_zarr(const std::filesystem::path& path, std::optional<std::uint64_t> time = {});

}  // namespace adamas::io
