#include "isosurface/storage/restore.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "isosurface/volume/samples.h"

namespace adamas {

namespace {

/// The coordinates of a part that a block of its LOD has along an axis: from `begin` to `end`, both included.
struct BlockSpan {
  std::int32_t begin, end;
  BlockSpan(std::int32_t block, std::int32_t first, std::int32_t last)
      : begin(std::max(first, PageGrid::kSide * block)),
        end(std::min(last, PageGrid::kSide * block + PageGrid::kSide - 1)) {}
};

/// The bytes of the pages that restoring a part needs at a time: one row of pages of its LOD, each of which
/// is needed once, and a few rows of coarser ones. They count twice, since pages leave a cache in no strict
/// order. Those of the steps that the step is coded with are needed at the same time.
template <class Word>
std::size_t working_set(const PageGrid& grid, std::uint32_t step, const RestoredPart& part) {
  const std::size_t steps = 1 + step % kWholeSteps;
  std::size_t pages = 0;
  for (int lod = part.lod; lod <= grid.top(); ++lod) {
    const auto along = [&](int axis) {
      const std::int32_t span = (part.last[axis] - part.first[axis]) >> (lod - part.lod);
      return static_cast<std::size_t>(span / PageGrid::kSide + 3);
    };
    pages += lod == part.lod ? along(0) : 3 * along(0) * along(1);
  }
  return 2 * steps * pages * sizeof(PageSamples<Word>);
}

template <class Sample>
class Restorer {
 public:
  using Word = OrderedWord<Sample>;

  Restorer(StoreFile& file, std::uint32_t step, const RestoredPart& part, std::size_t memory)
      : file_(file),
        part_(part),
        pages_(file, step, std::min(memory, working_set<Word>(file.grid(), step, part))) {}

  PageCounts run(const std::function<void(std::span<const std::byte>)>& sink, Progress& progress) {
    const std::size_t plane = part_.grid.plane_samples();
    std::vector<Sample> planes(PageGrid::kSide * plane);
    constexpr std::int32_t kSide = PageGrid::kSide;
    for (std::int32_t block = part_.first.k / kSide; block <= part_.last.k / kSide; ++block) {
      const BlockSpan z(block, part_.first.k, part_.last.k);
      const double planes_done = z.begin - part_.first.k;
      for (std::int32_t y = part_.first.j / kSide; y <= part_.last.j / kSide; ++y) {
        progress.step("restoring", planes_done / (part_.last.k - part_.first.k + 1));
        for (std::int32_t x = part_.first.i / kSide; x <= part_.last.i / kSide; ++x)
          copy({part_.lod, {x, y, block}}, z.begin, planes);
      }
      for (std::int32_t k = z.begin; k <= z.end; ++k) {
        const auto at = static_cast<std::size_t>(k - z.begin) * plane;
        sink(std::as_bytes(std::span(planes).subspan(at, plane)));
      }
    }
    return pages_.counts();
  }

 private:
  /// Copies what a page has of the part to the planes, the first of which is k = `base`.
  void copy(const PageId& id, std::int32_t base, std::vector<Sample>& planes) {
    const PageSamples<Word>* page = pages_.samples(id);
    if (page == nullptr)
      fail("{}: {} is damaged, or one that it is predicted from", file_.name(), page_name(id));
    const BlockSpan x(id.block.i, part_.first.i, part_.last.i), y(id.block.j, part_.first.j, part_.last.j),
        z(id.block.k, part_.first.k, part_.last.k);
    for (std::int32_t k = z.begin; k <= z.end; ++k) {
      for (std::int32_t j = y.begin; j <= y.end; ++j) {
        const std::size_t from = PageGrid::place({x.begin, j, k}, 0);
        const auto row = static_cast<std::size_t>(k - base) * part_.grid.plane_samples() +
                         static_cast<std::size_t>(j - part_.first.j) * part_.grid.dimensions[0];
        Sample* to = planes.data() + row + (x.begin - part_.first.i);
        for (std::int32_t i = 0; i <= x.end - x.begin; ++i)
          to[i] = from_ordered<Sample>(page->samples[from + static_cast<std::size_t>(i)]);
      }
    }
  }

  StoreFile& file_;
  RestoredPart part_;
  StoredPages<Word> pages_;
};

}  // namespace

RestoredPart restored_part(const VolumeGrid& volume, int lod, const std::optional<Box3>& region,
                           const std::string& name) {
  const PageGrid pages(volume.dimensions);
  if (lod < 0 || lod > pages.top())
    fail("{}: expected a level from 0 to {}, found {}", name, pages.top(), lod);
  RestoredPart part;
  part.lod = lod;
  part.grid = volume;
  Vec3 first = volume.origin;
  for (int axis = 0; axis < 3; ++axis) {
    const double step = std::ldexp(volume.spacing[axis], lod);
    part.last[axis] = pages.last()[axis] >> lod;
    if (region) {
      // A sample on the region's border counts, whatever its place was rounded to.
      constexpr double kSlack = 1e-9;
      const double low = (region->min[axis] - volume.origin[axis]) / step - kSlack;
      const double high = (region->max[axis] - volume.origin[axis]) / step + kSlack;
      const double end = part.last[axis];
      part.first[axis] = static_cast<std::int32_t>(std::clamp(std::ceil(low), 0.0, end + 1));
      part.last[axis] = static_cast<std::int32_t>(std::clamp(std::floor(high), -1.0, end));
      if (part.first[axis] > part.last[axis])
        fail("{}: expected a region with samples of level {}, found none along {}", name, lod, "xyz"[axis]);
    }
    const auto a = static_cast<std::size_t>(axis);
    part.grid.dimensions[a] = static_cast<std::uint64_t>(part.last[axis] - part.first[axis] + 1);
    first[axis] += part.first[axis] * step;
    part.grid.spacing[axis] = step;
  }
  part.grid.origin = volume.in_space(first);
  return part;
}

PageCounts restore(StoreFile& file, std::uint32_t step, const RestoredPart& part, std::size_t memory,
                   const std::function<void(std::span<const std::byte>)>& sink, Progress& progress) {
  return with_sample_type(part.grid.type, [&](auto sample) {
    return Restorer<decltype(sample)>(file, step, part, memory).run(sink, progress);
  });
}

}  // namespace adamas
