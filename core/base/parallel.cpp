#include "core/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>

#include "adamas/progress.h"
#include "adamas/stopping_signals.h"
#include "core/base/loop_progress.h"

namespace adamas::inline core {

namespace {

/// The thread that handles signals, and these signals: set by block_signals_in_workers before there is any
/// worker.
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

/// The greatest number of threads that a loop may take; 0 for all cores.
std::atomic<unsigned> limit = 0;

/// How many loops the thread is within.
thread_local int depth = 0;

/// Marks the thread as one that runs a part of a loop.
struct WithinLoop {
  WithinLoop() { ++depth; }
  WithinLoop(const WithinLoop&) = delete;
  WithinLoop& operator=(const WithinLoop&) = delete;
  ~WithinLoop() { --depth; }
};

/// Runs a loop with as many threads as are allowed. Each thread that starts loops has an arena of its own, so
/// that the threads of the host program, and loops that its other threads start, are left as they are. The
/// arena is kept from loop to loop, since workers seldom come to a new one.
template <class Loop>
void within_limit(const Loop& loop) {
  const unsigned threads = limit;
  if (threads == 0 || depth > 0) return loop();
  thread_local std::unique_ptr<tbb::task_arena> arena;
  thread_local unsigned size = 0;
  if (size != threads) {
    arena = std::make_unique<tbb::task_arena>(static_cast<int>(threads));
    size = threads;
  }
  arena->execute(loop);
}

}  // namespace

void parallel_chunks(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (count + grain - 1) / grain;
  LoopProgress* const progress = LoopProgress::of_thread();
  const auto items = static_cast<double>(count);
  std::atomic<std::size_t> begun = 0;
  const auto run = [&](std::size_t chunk) {
    leave_signals_to_keeper();
    const WithinLoop within;
    const std::size_t begin = chunk * grain, end = std::min(begin + grain, count);
    const auto done = static_cast<double>(begun++) / static_cast<double>(chunks);
    // The other threads of the loop have no LoopProgress of their own.
    if (progress == nullptr || LoopProgress::of_thread() != progress) return body(begin, end);
    progress->run(items, done, [&] { body(begin, end); });
  };
  // A thread that waits for a loop within a loop must not take up a chunk of the outer one: it may hold a
  // lock.
  within_limit(
      [&] { tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, chunks, run); }); });
  if (progress != nullptr) progress->end_loop(items);
}

}  // namespace adamas::inline core

namespace adamas {

void set_thread_limit(unsigned threads) {
  // A loop can use more threads than there are cores only if the whole process may.
  static std::unique_ptr<tbb::global_control> more;
  const bool beyond_cores = threads > std::max(1u, std::thread::hardware_concurrency());
  more = beyond_cores
             ? std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads)
             : nullptr;
  limit = threads;
}

unsigned thread_limit() {
  const unsigned threads = limit;
  return threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
}

void block_signals_in_workers(const sigset_t& signals) { keeper = {true, pthread_self(), signals}; }

}  // namespace adamas
