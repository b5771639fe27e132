#include "isosurface/storage/restore.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "isosurface/storage/step_pages.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

namespace {

/// The coordinates of a part that a block of its LOD has along an axis: from `begin` to `end`, both included.
struct BlockSpan {
  std::int32_t begin, end;
  BlockSpan(std::int32_t block, std::int32_t first, std::int32_t last)
      : begin(std::max(first, PageGrid::kSide * block)),
        end(std::min(last, PageGrid::kSide * block + PageGrid::kSide - 1)) {}
};

/// The bytes of the pages that restoring a part of a step needs at a time: one row of pages of its LOD, each
/// of which is needed once, and a few rows of coarser ones. They count twice, since pages leave a cache in no
/// strict order.
template <class Word>
std::size_t working_set_of_step(const PageGrid& grid, const RestoredPart& part) {
  std::size_t pages = 0;
  for (int lod = part.lod; lod <= grid.top(); ++lod) {
    const auto along = [&](int axis) {
      const std::int32_t span = (part.last[axis] - part.first[axis]) >> (lod - part.lod);
      return static_cast<std::size_t>(span / PageGrid::kSide + 3);
    };
    pages += lod == part.lod ? along(0) : 3 * along(0) * along(1);
  }
  return 2 * pages * sizeof(PageSamples<Word>);
}

/// Some steps side by side.
template <class Sample>
class Restorer {
 public:
  using Word = OrderedWord<Sample>;

  Restorer(StoreFile& file, const StepRange& range, const RestoredPart& part, std::size_t memory)
      : file_(file), part_(part), pages_(file, std::min(memory, working_set(file.grid(), range, part))) {
    for (std::uint32_t step = range.first; step <= range.last; ++step)
      steps_.push_back({&pages_.at(step), std::vector<Sample>(PageGrid::kSide * part.grid.plane_samples())});
  }

  PageCounts run(const std::function<void(std::uint32_t, std::span<const std::byte>)>& sink,
                 Progress& progress) {
    const std::size_t plane = part_.grid.plane_samples();
    constexpr std::int32_t kSide = PageGrid::kSide;
    for (std::int32_t block = part_.first.k / kSide; block <= part_.last.k / kSide; ++block) {
      const BlockSpan z(block, part_.first.k, part_.last.k);
      const double planes_done = z.begin - part_.first.k;
      for (std::int32_t y = part_.first.j / kSide; y <= part_.last.j / kSide; ++y) {
        progress.step("restoring", planes_done / (part_.last.k - part_.first.k + 1));
        for (Step& step : steps_) copy_row(step, {0, y, block}, z.begin);
      }
      for (const Step& step : steps_) {
        for (std::int32_t k = z.begin; k <= z.end; ++k) {
          const auto at = static_cast<std::size_t>(k - z.begin) * plane;
          sink(step.pages->step(), std::as_bytes(std::span(step.planes).subspan(at, plane)));
        }
      }
    }
    return pages_.counts();
  }

  /// Which of the steps lack a page of the part.
  std::vector<std::uint32_t> damaged(Progress& progress) {
    std::vector<std::uint32_t> found;
    const LatticePoint begin = block_of(part_.first), end = block_of(part_.last);
    for (LatticePoint block = begin; block.k <= end.k; ++block.k) {
      progress.step("looking for damage", static_cast<double>(block.k - begin.k) / (end.k - begin.k + 1));
      for (block.j = begin.j; block.j <= end.j; ++block.j) {
        for (block.i = begin.i; block.i <= end.i; ++block.i) {
          for (const Step& step : steps_) {
            if (step.pages->samples({part_.lod, block}) == nullptr) found.push_back(step.pages->step());
          }
        }
      }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

 private:
  struct Step {
    StoredPages<Word>* pages;
    std::vector<Sample> planes;  ///< of a row of blocks along k
  };

  void copy_row(Step& step, LatticePoint block, std::int32_t base) {
    const std::int32_t end = part_.last.i / PageGrid::kSide;
    for (block.i = part_.first.i / PageGrid::kSide; block.i <= end; ++block.i)
      copy(*step.pages, {part_.lod, block}, base, step.planes);
  }

  /// Copies what a page has of the part to the planes, the first of which is k = `base`.
  void copy(StoredPages<Word>& pages, const PageId& id, std::int32_t base, std::vector<Sample>& planes) {
    const PageSamples<Word>* page = pages.samples(id);
    if (page == nullptr)
      throw DamagedPage(fmt::format("{}: {} is damaged{}, or one that it is predicted from", file_.name(),
                                    page_name(id),
                                    file_.steps() > 1 ? fmt::format(" at step {}", pages.step()) : ""));
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

  static LatticePoint block_of(LatticePoint sample) {
    return {sample.i / PageGrid::kSide, sample.j / PageGrid::kSide, sample.k / PageGrid::kSide};
  }

  static std::size_t working_set(const PageGrid& grid, const StepRange& range, const RestoredPart& part) {
    // The first one needs those that it is coded with too.
    const std::size_t steps = range.last - range.first + 1 + range.first % kWholeSteps;
    return steps * working_set_of_step<Word>(grid, part);
  }

  StoreFile& file_;
  RestoredPart part_;
  StepPages<Word> pages_;
  std::vector<Step> steps_;
};

/// Calls fn(restorer) for one group of steps that are best restored together after another.
template <class Fn>
void for_each_group(StoreFile& file, const StepRange& steps, const RestoredPart& part, std::size_t memory,
                    Fn&& fn) {
  with_sample_type(part.grid.type, [&](auto sample) {
    for (const StepRange& some : restored_together(steps, restored_slab_bytes(part), memory)) {
      Restorer<decltype(sample)> restorer(file, some, part, memory);
      fn(restorer);
    }
  });
}

/// Along one axis of a part: its first and its last sample, in units of 2^lod; none where it is empty.
std::pair<std::int32_t, std::int32_t> samples_within(double low, double high, std::int32_t last) {
  // A sample on the region's border counts, whatever its place was rounded to.
  constexpr double kSlack = 1e-9;
  const double end = last;
  return {static_cast<std::int32_t>(std::clamp(std::ceil(low - kSlack), 0.0, end + 1)),
          static_cast<std::int32_t>(std::clamp(std::floor(high + kSlack), -1.0, end))};
}

/// The part, with the first axis along which it has no sample; 3 where it has.
std::pair<RestoredPart, int> find_part(const VolumeGrid& volume, int lod, const std::optional<Box3>& region) {
  RestoredPart part;
  part.lod = lod;
  part.grid = volume;
  Vec3 first = volume.origin;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double step = std::ldexp(volume.spacing[axis], lod);
    part.last[axis] = static_cast<std::int32_t>(volume.dimensions[a] - 1) >> lod;
    if (region)
      std::tie(part.first[axis], part.last[axis]) =
          samples_within((region->min[axis] - volume.origin[axis]) / step,
                         (region->max[axis] - volume.origin[axis]) / step, part.last[axis]);
    if (part.first[axis] > part.last[axis]) return {part, axis};
    part.grid.dimensions[a] = static_cast<std::uint64_t>(part.last[axis] - part.first[axis] + 1);
    first[axis] += part.first[axis] * step;
    part.grid.spacing[axis] = step;
  }
  part.grid.origin = volume.in_space(first);
  return {part, 3};
}

}  // namespace

RestoredPart restored_part(const VolumeGrid& volume, int lod, const std::optional<Box3>& region,
                           const std::string& name) {
  const PageGrid pages(volume.dimensions);
  if (lod < 0 || lod > pages.top())
    fail("{}: expected a level from 0 to {}, found {}", name, pages.top(), lod);
  const auto [part, empty] = find_part(volume, lod, region);
  if (empty < 3)
    fail("{}: expected a region with samples of level {}, found none along {}", name, lod, "xyz"[empty]);
  return part;
}

std::vector<RestoredPart> restored_levels(const VolumeGrid& volume, int lod,
                                          const std::optional<Box3>& region, std::uint64_t enough,
                                          const std::string& name) {
  const int top = PageGrid(volume.dimensions).top();
  std::vector<RestoredPart> levels{restored_part(volume, lod, region, name)};
  while (levels.back().lod < top) {
    const auto& n = levels.back().grid.dimensions;
    if (*std::max_element(n.begin(), n.end()) <= enough) break;
    const auto [part, empty] = find_part(volume, levels.back().lod + 1, region);
    if (empty < 3) break;
    levels.push_back(part);
  }
  return levels;
}

PageCounts restore(StoreFile& file, std::uint32_t step, const RestoredPart& part, std::size_t memory,
                   const std::function<void(std::span<const std::byte>)>& sink, Progress& progress) {
  return restore_steps(
      file, {step, step}, part, memory,
      [&sink](std::uint32_t, std::span<const std::byte> plane) { sink(plane); }, progress);
}

std::vector<StepRange> restored_together(const StepRange& steps, std::uint64_t bytes_each,
                                         std::size_t memory) {
  const std::uint64_t room = std::max<std::uint64_t>(1, memory / std::max<std::uint64_t>(1, bytes_each));
  std::vector<StepRange> groups;
  for (std::uint64_t first = steps.first, end = 0; first <= steps.last; first = end) {
    end = std::min(
        {first / kWholeSteps * kWholeSteps + kWholeSteps, first + room, std::uint64_t{steps.last} + 1});
    groups.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(end - 1)});
  }
  return groups;
}

std::uint64_t restored_slab_bytes(const RestoredPart& part) {
  return PageGrid::kSide * part.grid.plane_bytes();
}

PageCounts restore_steps(StoreFile& file, const StepRange& steps, const RestoredPart& part,
                         std::size_t memory,
                         const std::function<void(std::uint32_t, std::span<const std::byte>)>& sink,
                         Progress& progress) {
  PageCounts counts;
  for_each_group(file, steps, part, memory, [&](auto& restorer) { counts += restorer.run(sink, progress); });
  return counts;
}

std::vector<std::uint32_t> damaged_steps(StoreFile& file, const StepRange& steps, const RestoredPart& part,
                                         std::size_t memory, Progress& progress) {
  std::vector<std::uint32_t> all;
  for_each_group(file, steps, part, memory, [&](auto& restorer) {
    const std::vector<std::uint32_t> some = restorer.damaged(progress);
    all.insert(all.end(), some.begin(), some.end());
  });
  return all;
}

}  // namespace adamas::isosurface
