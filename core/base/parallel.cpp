#include "core/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>

#include "core/base/loop_progress.h"

namespace adamas::inline core {

namespace {

/// The thread that handles signals, and which: set by block_signals_in_workers before there is any worker.
struct Keeper {
  bool known = false;
  pthread_t thread{};
  sigset_t signals{};
} keeper;

/// Blocks these signals in any other thread, at its first call.
void leave_signals_to_keeper() {
  thread_local bool done = false;
  if (done) return;
  done = true;
  if (keeper.known && pthread_equal(pthread_self(), keeper.thread) == 0)
    pthread_sigmask(SIG_BLOCK, &keeper.signals, nullptr);
}

}  // namespace

void parallel_chunks(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (count + grain - 1) / grain;
  LoopProgress* const progress = LoopProgress::of_thread();
  std::atomic<std::size_t> begun = 0;
  // A thread that waits for a loop within a loop must not take up a chunk of the outer one: it may hold a
  // lock.
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
      leave_signals_to_keeper();
      const std::size_t begin = chunk * grain, end = std::min(begin + grain, count);
      const auto done = static_cast<double>(begun++) / static_cast<double>(chunks);
      // Other threads have none of their own.
      if (progress == nullptr || LoopProgress::of_thread() != progress) return body(begin, end);
      progress->run(done, [&] { body(begin, end); });
    });
  });
}

}  // namespace adamas::inline core

namespace adamas {

void set_thread_limit(unsigned threads) {
  static std::unique_ptr<tbb::global_control> control;
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads);
}

}  // namespace adamas

namespace adamas::inline core {

unsigned thread_limit() {
  return static_cast<unsigned>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void block_signals_in_workers(const sigset_t& signals) { keeper = {true, pthread_self(), signals}; }

}  // namespace adamas::inline core
