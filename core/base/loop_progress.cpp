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

void LoopProgress::begin_part(double end, double items) {
  if (current == nullptr || current->depth_ > 0) return;
  const double begin = current->part_end_;
  current->part_end_ = end;
  current->work_ = {.items = items, .begin = begin, .end = end};
  current->items_ = current->loop_items_ = current->done_ = 0;
  current->step();
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
  if (!(work_.items > 0)) return work_.begin > 0 ? work_.begin : -1;
  done_ = std::max(done_, std::min((items_ + loop_items_) / work_.items, 1.0));
  return work_.begin + done_ * (work_.end - work_.begin);
}

}  // namespace adamas::inline core
