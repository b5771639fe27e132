#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "adamas/progress.h"
#include "adamas/volume.h"
#include "core/base/error.h"
#include "core/geometry/vec3.h"
#include "isosurface/gradients/gradient_smoothing.h"
#include "isosurface/storage/store_format.h"
#include "isosurface/storage/store_lock.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

struct StoreOptions {
  SampleCoding coding = SampleCoding::kInterpolation;
  /// Where scratch data of up to four times the input may lie, and four bytes more for each sample's
  /// gradient; six, and the samples once more, where gradients are smoothed along time. Of a series all steps
  /// of a block lie there. Empty: the system's folder for temporary files.
  std::filesystem::path scratch{};
  bool gradients = false;  ///< whether the directions of samples' gradients are kept
  /// How these are smoothed first; none: not at all. Along time the steps of a block are smoothed, of each
  /// block by itself.
  std::optional<GradientSmoothingOptions> smoothing = GradientSmoothingOptions{};
  /// How many steps of a series are in a block, page by page, from 1 to kMostBlockSteps: reading a page's
  /// next steps goes fast where they are many, reading one step where they are few.
  std::uint32_t block_steps = 32;
  /// How many pages lie interleaved in time, a power of two up to kMostGroupPages (PageGroup): one has each
  /// page's steps side by side, many have whole steps of a part of the volume side by side. Their bytes of
  /// all steps of a block are held in memory.
  std::uint32_t group_pages = 1;
};

/// The steps of a series of volumes on one grid.
struct SeriesSource {
  VolumeGrid grid;
  std::vector<double> times;  ///< of the steps, ascending
  std::function<PlaneSource(std::uint32_t step)> planes;
};

/// What became of a volume.
struct StoreFigures {
  StoreBytes bytes;
  std::uint64_t file_bytes = 0;
  std::uint64_t pages = 0;
};

/// Preprocesses the steps of a series, orders them in pages and compresses these into a store at `path`;
/// messages name `shown`. Planes are asked for several times, in any order. Needs 1 GiB of memory and 64
/// bytes for each sample of a plane of equal k; the file is the same whatever the number of threads.
StoreFigures build_series(const std::filesystem::path& path, const std::string& shown,
                          const SeriesSource& series, const StoreOptions& options,
                          Progress& progress = SilentProgress::instance());

/// Adds steps, whose times are after those of the store that is locked, behind its last ones, with its
/// coding, unless they are to be plain, in groups as large as its own, and with gradients if it has some. Who
/// opens the file meanwhile, or after this was killed, finds all steps of the blocks that are finished.
StoreFigures append_series(const StoreLock& store, const SeriesSource& series, StoreOptions options,
                           Progress& progress = SilentProgress::instance());

/// The same of one volume, a series of one step.
StoreFigures build_store(const std::filesystem::path& path, const std::string& shown, const VolumeGrid& grid,
                         const PlaneSource& planes, const StoreOptions& options,
                         Progress& progress = SilentProgress::instance());

}  // namespace adamas::isosurface
