#include "cli/restored_steps.h"

#include <vector>

#include "cli/store_options.h"
#include "core/base/error.h"

namespace adamas {

PageCounts restore_some(StoreFile& file, const StepRange& some, const StepRange& all,
                        const RestoredPart& part, std::size_t memory,
                        const std::function<void(std::uint32_t, std::span<const std::byte>)>& sink,
                        Session& session) {
  try {
    return restore_steps(file, some, part, memory, sink, session.console);
  } catch (const DamagedPage& damage) {
    if (all.first == all.last) throw;
    const std::vector<std::uint32_t> lost = damaged_steps(file, all, part, memory, session.console);
    const bool is_all = lost.size() == all.last - all.first + 1;
    fail("{}: {} cannot be restored{}", damage.what(), steps_text(lost),
         is_all ? "" : fmt::format(", the others from {} to {} can, by --steps", all.first, all.last));
  }
}

}  // namespace adamas
