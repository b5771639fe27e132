#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "isosurface/gradients/gradient_smoothing.h"
#include "isosurface/storage/store_format.h"

namespace adamas::isosurface {

/// Options that say how a volume or a series is stored.
struct StoreOptions {
  SampleCoding coding = SampleCoding::kInterpolation;
  /// The folder for temporary files: up to four times the bytes of the input, and four bytes for each
  /// sample's gradient; six, and the samples once more, if gradients are smoothed along time. It holds all
  /// steps of a block. If it is empty, it is the system's folder for temporary files.
  std::filesystem::path scratch{};
  bool gradients = false;  ///< store the directions of samples' gradients
  /// The smoothing of gradients before their directions are stored; none: they are not smoothed. Smoothing
  /// along time uses the steps of one block.
  std::optional<GradientSmoothingOptions> smoothing = GradientSmoothingOptions{};
  /// The number of steps of a series in a block, from 1 to kMostBlockSteps. With more steps, a page's next
  /// steps are read faster; with fewer, one step is read faster.
  std::uint32_t block_steps = 32;
  /// The number of pages that are interleaved in time (PageGroup), a power of two up to kMostGroupPages. With
  /// one, the steps of each page are side by side; with many, whole steps of a part of the volume are. The
  /// bytes of a group for all steps of a block are held in memory.
  std::uint32_t group_pages = 1;
};

/// Sizes of the stored data.
struct StoreFigures {
  StoreBytes bytes;
  std::uint64_t file_bytes = 0;
  std::uint64_t pages = 0;
};

}  // namespace adamas::isosurface
