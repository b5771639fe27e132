#include "timevarying/restore_steps.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "core/base/sort_unique.h"
#include "isosurface/storage/number_remainders.h"
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

/// Makes the numbers of a step of its samples, plane by plane.
class NumberRestorer {
 public:
  NumberRestorer(StoreFile& file, std::uint32_t step, const RestoredPart& part)
      : file_(file), step_(step), part_(part), type_(file.header().numbers.type), planes_(part.first.k) {}

  /// Returns the numbers of the next plane. Throws DamagedPage where remainders are damaged.
  std::span<const std::byte> next(std::span<const std::byte> samples) {
    numbers_.resize(part_.grid.plane_samples() * stored_bytes(type_));
    const std::uint64_t k = static_cast<std::uint64_t>(planes_++) << part_.lod;
    if (has_remainders(type_)) {
      load(k);
      values_.resize(part_.grid.plane_samples());
      std::memcpy(values_.data(), samples.data(), samples.size());
      add_remainders(type_, values_, of_plane_, numbers_);
    } else {
      nearest_numbers(type_, samples, numbers_);
    }
    return numbers_;
  }
  [[nodiscard]] bool at_end() const { return planes_ > part_.last.k; }

 private:
  /// Finds the remainders of the samples of the part in plane k of LOD 0.
  void load(std::uint64_t k) {
    const VolumeGrid& volume = file_.header().grid;
    const std::uint64_t planes = remainder_planes(volume), record = k / planes;
    if (record_ != record) {
      if (!read_remainders(file_, step_, record, remainders_))
        throw DamagedPage(fmt::format("{}: the remainders of planes {} to {} are damaged{}", file_.name(),
                                      record * planes,
                                      std::min((record + 1) * planes, volume.dimensions[2]) - 1,
                                      file_.steps() > 1 ? fmt::format(" at step {}", step_) : ""));
      record_ = record;
    }
    const std::size_t width = stored_bytes(type_);
    of_plane_.clear();
    for (std::int32_t j = part_.first.j; j <= part_.last.j; ++j) {
      const std::uint64_t row = (k % planes) * volume.plane_samples() +
                                (static_cast<std::uint64_t>(j) << part_.lod) * volume.dimensions[0];
      for (std::int32_t i = part_.first.i; i <= part_.last.i; ++i) {
        const std::uint64_t at = (row + (static_cast<std::uint64_t>(i) << part_.lod)) * width;
        of_plane_.insert(of_plane_.end(), remainders_.begin() + static_cast<std::ptrdiff_t>(at),
                         remainders_.begin() + static_cast<std::ptrdiff_t>(at + width));
      }
    }
  }

  StoreFile& file_;
  std::uint32_t step_;
  RestoredPart part_;
  StoredType type_;
  std::int32_t planes_;                  ///< the next plane of the part
  std::optional<std::uint64_t> record_;  ///< the record that remainders_ are of
  std::vector<std::byte> remainders_, of_plane_, numbers_;
  std::vector<float> values_;
};

/// Returns whether remainders that a part of a step needs are damaged.
bool has_damaged_remainders(StoreFile& file, std::uint32_t step, const RestoredPart& part) {
  const StoreHeader& header = file.header();
  if (!has_remainders(header.numbers.type)) return false;
  const std::uint64_t planes = remainder_planes(header.grid);
  std::vector<std::byte> remainders;
  std::optional<std::uint64_t> before;
  for (std::int32_t k = part.first.k; k <= part.last.k; ++k) {
    const std::uint64_t record = (static_cast<std::uint64_t>(k) << part.lod) / planes;
    if (std::exchange(before, record) == record) continue;
    if (!read_remainders(file, step, record, remainders)) return true;
  }
  return false;
}

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

bool read_remainders(StoreFile& file, std::uint32_t step, std::uint64_t record,
                     std::vector<std::byte>& remainders) {
  const StoreHeader& header = file.header();
  const std::uint64_t planes = remainder_planes(header.grid);
  const std::uint64_t count = std::min(planes, header.grid.dimensions[2] - record * planes);
  const auto bytes = file.remainders(step, record);
  return bytes &&
         decode_remainders(header.numbers.type, *bytes, count * header.grid.plane_samples(), remainders);
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

PageReads restore_numbers(StoreFile& file, const StepRange& steps, const RestoredPart& part,
                          std::size_t memory,
                          const std::function<void(std::uint32_t, std::span<const std::byte>)>& sink,
                          Progress& progress) {
  if (file.header().numbers.type == stored_type(part.grid.type))
    return restore_steps(file, steps, part, memory, sink, progress);
  std::map<std::uint32_t, NumberRestorer> restorers;
  const auto to_numbers = [&](std::uint32_t step, std::span<const std::byte> plane) {
    NumberRestorer& restorer = restorers.try_emplace(step, file, step, part).first->second;
    sink(step, restorer.next(plane));
    if (restorer.at_end()) restorers.erase(step);
  };
  return restore_steps(file, steps, part, memory, to_numbers, progress);
}

std::vector<std::uint32_t> damaged_steps(StoreFile& file, const StepRange& steps, const RestoredPart& part,
                                         std::size_t memory, Progress& progress) {
  std::vector<std::uint32_t> all;
  for_each_group(file, steps, part, memory, [&](auto& restorer) {
    const std::vector<std::uint32_t> some = restorer.damaged(progress);
    all.insert(all.end(), some.begin(), some.end());
  });
  for (std::uint32_t step = steps.first; step <= steps.last; ++step) {
    if (has_damaged_remainders(file, step, part)) all.push_back(step);
  }
  sort_unique(all);
  return all;
}

}  // namespace adamas::timevarying
