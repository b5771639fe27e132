#include "core/base/loop_progress.h"

#include <utility>

namespace adamas::inline core {

namespace {
thread_local LoopProgress* current = nullptr;
}

LoopProgress::LoopProgress(Progress& progress, std::string stage)
    : progress_(progress), stage_(std::move(stage)), before_(current) {
  // step() may throw; the destructor does not run then, so `current` is set afterwards.
  if (!stage_.empty()) progress_.step(stage_, 0);
  current = this;
}

LoopProgress::~LoopProgress() { current = before_; }

LoopProgress* LoopProgress::of_thread() { return current; }

void LoopProgress::check() {
  if (current != nullptr) current->step(-1);
}

void LoopProgress::step(double done) {
  if (stage_.empty() || depth_ > 0) return progress_.check();
  progress_.step(stage_, done);
}

}  // namespace adamas::inline core
