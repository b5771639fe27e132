#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "adamas/progress.h"
#include "timevarying/restore_steps.h"

namespace adamas::workflow {

/// Some steps of a series, in ascending order.
using StepNumbers = std::vector<std::uint32_t>;

/// The groups of restored_together() of steps of which some may be left out.
std::vector<StepRange> restored_groups(const StepNumbers& steps, std::uint64_t bytes_each,
                                       std::size_t memory);

/// The steps that were restored, and those that cannot be.
struct RestoredSteps {
  StepNumbers kept, lost;
};

/// Calls `write` with all steps of a range, or where a page is damaged, once more with those that can be
/// restored; what was written before does not count then. A note tells of the others. `part` holds all that
/// `write` restores of a step. Throws DamagedPage of one step alone, and Error where no step can be restored.
RestoredSteps restore_what_can_be(isosurface::StoreFile& file, const StepRange& all,
                                  const isosurface::RestoredPart& part, std::size_t memory,
                                  const std::function<void(const StepNumbers&)>& write, Progress& progress);

}  // namespace adamas::workflow
