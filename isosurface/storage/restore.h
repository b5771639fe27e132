#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/geometry/vec3.h"
#include "isosurface/storage/stored_pages.h"

namespace adamas::isosurface {

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

/// The part at an LOD and at the coarser ones that it has samples of, down to the first where no axis has
/// more than `enough` samples. Throws Error as restored_part.
std::vector<RestoredPart> restored_levels(const VolumeGrid& volume, int lod,
                                          const std::optional<Box3>& region, std::uint64_t enough,
                                          const std::string& name);

/// A page is damaged that is needed, or one that it is predicted from; the message names the page and, of a
/// series, the step.
class DamagedPage : public Error {
 public:
  explicit DamagedPage(const std::string& message) : Error(message, ErrorKind::kDamaged) {}
};

/// Gives the part's planes of equal k in ascending order to `sink`, as samples of the volume's type. Only
/// pages that the part needs are read. Throws DamagedPage.
PageCounts restore(StoreFile& file, std::uint32_t step, const RestoredPart& part, std::size_t memory,
                   const std::function<void(std::span<const std::byte>)>& sink, Progress& progress);

/// Steps of a series, from the first to the last.
struct StepRange {
  std::uint32_t first = 0, last = 0;
};

/// Some steps in groups that are best restored together: as many as share no page that they are coded with
/// with later ones, but not more than take `memory` at so many bytes each.
std::vector<StepRange> restored_together(const StepRange& steps, std::uint64_t bytes_each,
                                         std::size_t memory);

/// The same as restore() of several steps, each group of restored_together() side by side, row of pages by
/// row of pages: what a page is coded with in time has just been decoded. `sink` takes a step and its next
/// plane.
PageCounts restore_steps(StoreFile& file, const StepRange& steps, const RestoredPart& part,
                         std::size_t memory,
                         const std::function<void(std::uint32_t, std::span<const std::byte>)>& sink,
                         Progress& progress);

/// Which of some steps cannot be restored, in ascending order. All are decoded.
std::vector<std::uint32_t> damaged_steps(StoreFile& file, const StepRange& steps, const RestoredPart& part,
                                         std::size_t memory, Progress& progress);

/// The bytes of planes that restoring holds for each step.
std::uint64_t restored_slab_bytes(const RestoredPart& part);

}  // namespace adamas::isosurface
