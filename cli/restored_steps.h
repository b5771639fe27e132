#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "cli/command.h"
#include "isosurface/storage/restore.h"

namespace adamas {

/// The same as restore_steps() of some of `all` the steps that a run restores. Where a page is damaged, the
/// message says which of all these cannot be restored.
PageCounts restore_some(StoreFile& file, const StepRange& some, const StepRange& all,
                        const RestoredPart& part, std::size_t memory,
                        const std::function<void(std::uint32_t, std::span<const std::byte>)>& sink,
                        Session& session);

}  // namespace adamas
