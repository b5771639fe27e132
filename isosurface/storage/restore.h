#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/progress.h"
#include "core/base/error.h"
#include "isosurface/storage/stored_pages.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// Samples of an LOD in a box: those whose coordinates are multiples of 2^lod.
struct RestoredPart {
  int lod = 0;
  /// The first and the last sample along each axis, in units of 2^lod.
  LatticePoint first{}, last{};
  VolumeGrid grid;
};

/// Returns the part of a volume at an LOD, whole or restricted to a region of the volume's frame. Throws
/// Error, which begins with `name`, where there is no such LOD or no sample in the region.
RestoredPart restored_part(const VolumeGrid& volume, int lod, const std::optional<Box3>& region,
                           const std::string& name);

/// Returns the part at an LOD and at the coarser ones that it has samples of, up to the first where no axis
/// has more than `enough` samples. Throws Error as restored_part() does.
std::vector<RestoredPart> restored_lods(const VolumeGrid& volume, int lod, const std::optional<Box3>& region,
                                        std::uint64_t enough, const std::string& name);

/// An Error: a page that is needed is damaged, or one that it is predicted from. The message names the page
/// and, for a series, the step.
class DamagedPage : public Error {
 public:
  explicit DamagedPage(const std::string& message) : Error(message, ErrorKind::kDamaged) {}
};

/// Copies the samples of a part from the pages of one step, one row of pages after another.
template <class Sample>
class SlabRestorer {
 public:
  using Word = OrderedWord<Sample>;

  /// Makes the object. `pages` and `part` must outlive it.
  SlabRestorer(StoredPages<Word>& pages, const RestoredPart& part);

  [[nodiscard]] StoredPages<Word>& pages() const { return pages_; }
  /// Copies the points of the part from the pages of a row along i, at blocks j and k of the part's LOD. All
  /// rows of equal k make a slab. Throws DamagedPage.
  void copy_row(std::int32_t j, std::int32_t k);
  /// Calls sink(plane) for the planes of the slab at block k, as samples of the volume's type.
  template <class Sink>
  void for_each_plane(std::int32_t k, Sink&& sink) const {
    const std::size_t plane = part_.grid.plane_samples();
    for (std::size_t n = 0; n < plane_count(k); ++n)
      sink(std::as_bytes(std::span(planes_).subspan(n * plane, plane)));
  }

 private:
  [[nodiscard]] std::size_t plane_count(std::int32_t k) const;
  void copy(const PageId& id);

  StoredPages<Word>& pages_;
  const RestoredPart& part_;
  std::vector<Sample> planes_;  ///< the planes of a slab
};

/// Restores a part slab by slab, for several steps side by side: calls sink(restorer, plane) for the planes
/// of equal k of each restorer, in ascending order. Throws DamagedPage.
template <class Sample, class Sink>
void restore_slabs(std::span<SlabRestorer<Sample>> restorers, const RestoredPart& part, Progress& progress,
                   Sink&& sink) {
  constexpr std::int32_t kSide = PageGrid::kSide;
  for (std::int32_t k = part.first.k / kSide; k <= part.last.k / kSide; ++k) {
    const double planes_done = std::max(part.first.k, kSide * k) - part.first.k;
    for (std::int32_t j = part.first.j / kSide; j <= part.last.j / kSide; ++j) {
      progress.step("restoring", planes_done / (part.last.k - part.first.k + 1));
      for (SlabRestorer<Sample>& each : restorers) each.copy_row(j, k);
    }
    for (const SlabRestorer<Sample>& each : restorers)
      each.for_each_plane(k, [&](std::span<const std::byte> plane) { sink(each, plane); });
  }
}

/// Returns the bytes of decoded pages that restoring a part of one step needs at a time. More memory is of no
/// use.
template <class Word>
std::size_t restored_page_bytes(const PageGrid& grid, const RestoredPart& part);

/// Returns the bytes of planes that restoring holds for each step.
std::uint64_t restored_slab_bytes(const RestoredPart& part);

}  // namespace adamas::isosurface
