#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "adamas/progress.h"
#include "timevarying/restore_steps.h"

namespace adamas::workflow {

/// Numbers of steps of a series, in ascending order.
using StepNumbers = std::vector<std::uint32_t>;

/// Returns the groups of restored_together() for steps some of which may be left out.
std::vector<StepRange> restored_groups(const StepNumbers& steps, std::uint64_t bytes_each,
                                       std::size_t memory);

/// The steps that were restored, and those that cannot be restored.
struct RestoredSteps {
  StepNumbers kept, lost;
};

/// Calls `write` with all steps of a range or, where a page is damaged, once more with those that can be
/// restored; the earlier output is void then. A note names the others. `part` contains all samples that
/// `write` restores of a step. Throws DamagedPage for a single step, and Error where no step can be restored.
RestoredSteps restore_what_can_be(isosurface::StoreFile& file, const StepRange& all,
                                  const isosurface::RestoredPart& part, std::size_t memory,
                                  const std::function<void(const StepNumbers&)>& write, Progress& progress);

}  // namespace adamas::workflow
