#include "workflow/stores/restored_steps.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "adamas/steps.h"
#include "core/base/error.h"

namespace adamas::workflow {

using namespace isosurface;
using namespace timevarying;

std::vector<StepRange> restored_groups(const StepNumbers& steps, std::uint64_t bytes_each,
                                       std::size_t memory) {
  std::vector<StepRange> groups;
  for (std::size_t begin = 0, end = 0; begin < steps.size(); begin = end) {
    end = begin + 1;
    while (end < steps.size() && steps[end] == steps[end - 1] + 1) ++end;
    const auto some = restored_together({steps[begin], steps[end - 1]}, bytes_each, memory);
    groups.insert(groups.end(), some.begin(), some.end());
  }
  return groups;
}

RestoredSteps restore_what_can_be(StoreFile& file, const StepRange& all, const RestoredPart& part,
                                  std::size_t memory, const std::function<void(const StepNumbers&)>& write,
                                  Progress& progress) {
  StepNumbers steps(all.last - all.first + 1);
  std::iota(steps.begin(), steps.end(), all.first);
  try {
    write(steps);
    return {std::move(steps), {}};
  } catch (const DamagedPage& damage) {
    if (steps.size() == 1) throw;
    StepNumbers lost = damaged_steps(file, all, part, memory, progress);
    std::erase_if(steps, [&lost](std::uint32_t step) { return std::ranges::binary_search(lost, step); });
    if (steps.empty()) fail("{}: {} cannot be restored", damage.what(), steps_text(lost));
    write(steps);
    progress.note(NoteKind::kIncomplete, fmt::format("{}: {} left out", damage.what(), steps_text(lost)));
    return {std::move(steps), std::move(lost)};
  }
}

}  // namespace adamas::workflow
