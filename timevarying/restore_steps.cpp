#include "timevarying/restore_steps.h"

#include <algorithm>

#include "core/base/sort_unique.h"
#include "timevarying/step_pages.h"

namespace adamas::timevarying {

using namespace isosurface;

namespace {

/// Restores several steps together.
template <class Sample>
class StepRestorer {
 public:
  using Word = OrderedWord<Sample>;

  StepRestorer(StoreFile& file, const StepRange& range, const RestoredPart& part, std::size_t memory)
      : part_(part), pages_(file, std::min(memory, page_bytes(file.grid(), range, part))) {
    for (std::uint32_t step = range.first; step <= range.last; ++step)
      steps_.emplace_back(pages_.at(step), part_);
  }
  StepRestorer(const StepRestorer&) = delete;
  StepRestorer& operator=(const StepRestorer&) = delete;

  PageReads run(const std::function<void(std::uint32_t, std::span<const std::byte>)>& sink,
                Progress& progress) {
    restore_slabs(std::span(steps_), part_, progress,
                  [&](const SlabRestorer<Sample>& step, std::span<const std::byte> plane) {
                    sink(step.pages().step(), plane);
                  });
    return pages_.counts();
  }

  /// Finds the steps in which a page of the part is damaged.
  std::vector<std::uint32_t> damaged(Progress& progress) {
    std::vector<std::uint32_t> found;
    const LatticePoint begin = block_of(part_.first), end = block_of(part_.last);
    for (LatticePoint block = begin; block.k <= end.k; ++block.k) {
      progress.step("looking for damage", static_cast<double>(block.k - begin.k) / (end.k - begin.k + 1));
      for (block.j = begin.j; block.j <= end.j; ++block.j) {
        for (block.i = begin.i; block.i <= end.i; ++block.i) {
          for (const SlabRestorer<Sample>& step : steps_) {
            if (step.pages().samples({part_.lod, block}) == nullptr) found.push_back(step.pages().step());
          }
        }
      }
    }
    sort_unique(found);
    return found;
  }

 private:
  static LatticePoint block_of(LatticePoint sample) {
    return {sample.i / PageGrid::kSide, sample.j / PageGrid::kSide, sample.k / PageGrid::kSide};
  }

  static std::size_t page_bytes(const PageGrid& grid, const StepRange& range, const RestoredPart& part) {
    // The first step also needs the steps that it is coded with.
    const std::size_t steps = range.last - range.first + 1 + range.first % kWholeSteps;
    return steps * restored_page_bytes<Word>(grid, part);
  }

  RestoredPart part_;
  StepPages<Word> pages_;
  std::vector<SlabRestorer<Sample>> steps_;
};

/// Calls fn(restorer) for one group of steps after another; each group is best restored together.
template <class Fn>
void for_each_group(StoreFile& file, const StepRange& steps, const RestoredPart& part, std::size_t memory,
                    Fn&& fn) {
  with_sample_type(part.grid.type, [&](auto sample) {
    for (const StepRange& some : restored_together(steps, restored_slab_bytes(part), memory)) {
      StepRestorer<decltype(sample)> restorer(file, some, part, memory);
      fn(restorer);
    }
  });
}

}  // namespace

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

PageReads restore_step(StoreFile& file, std::uint32_t step, const RestoredPart& part, std::size_t memory,
                       const std::function<void(std::span<const std::byte>)>& sink, Progress& progress) {
  return restore_steps(
      file, {step, step}, part, memory,
      [&sink](std::uint32_t, std::span<const std::byte> plane) { sink(plane); }, progress);
}

PageReads restore_steps(StoreFile& file, const StepRange& steps, const RestoredPart& part, std::size_t memory,
                        const std::function<void(std::uint32_t, std::span<const std::byte>)>& sink,
                        Progress& progress) {
  PageReads counts;
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

}  // namespace adamas::timevarying
