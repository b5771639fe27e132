#include "core/base/loop_progress.h"

#include <algorithm>
#include <utility>

namespace adamas::inline core {

namespace {
thread_local LoopProgress* current = nullptr;
}

LoopProgress::LoopProgress(Progress& progress, std::string stage, StageWork work)
    : progress_(progress), stage_(std::move(stage)), work_(work), before_(current) {
  // step() may throw; the destructor does not run then, so `current` is set afterwards.
  if (!stage_.empty()) step();
  current = this;
}

LoopProgress::~LoopProgress() { current = before_; }

LoopProgress* LoopProgress::of_thread() { return current; }

void LoopProgress::check() {
  if (current != nullptr) current->step();
}

void LoopProgress::count_items(double items) {
  if (current == nullptr || current->depth_ > 0) return;
  current->items_ += items;
  current->step();
}

void LoopProgress::step() {
  if (stage_.empty() || depth_ > 0) return progress_.check();
  progress_.step(stage_, part_done());
}

/// Returns the part of the stage that is done; negative where it is not known.
double LoopProgress::part_done() {
  if (!(work_.items > 0)) return -1;
  done_ = std::max(done_, std::min((items_ + loop_items_) / work_.items, 1.0));
  return work_.begin + done_ * (work_.end - work_.begin);
}

}  // namespace adamas::inline core
