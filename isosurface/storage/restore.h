#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/geometry/vec3.h"
#include "isosurface/storage/stored_pages.h"

namespace adamas {

/// Samples of an LOD in a box: those whose coordinates are multiples of 2^lod.
struct RestoredPart {
  int lod = 0;
  /// The first and the last sample along each axis, in units of 2^lod.
  LatticePoint first{}, last{};
  VolumeGrid grid;
};

/// The part of a volume at an LOD, whole or what of it lies in a region of the volume's frame. Throws Error,
/// which begins with `name`, where there is no such LOD or no sample in the region.
RestoredPart restored_part(const VolumeGrid& volume, int lod, const std::optional<Box3>& region,
                           const std::string& name);

/// Gives the part's planes of equal k in ascending order to `sink`, as samples of the volume's type. Only
/// pages that the part needs are read. Throws Error where a page is damaged.
PageCounts restore(StoreFile& file, std::uint32_t step, const RestoredPart& part, std::size_t memory,
                   const std::function<void(std::span<const std::byte>)>& sink, Progress& progress);

}  // namespace adamas
