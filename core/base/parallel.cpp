#include "core/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <thread>

namespace adamas {

void parallel_chunks(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (count + grain - 1) / grain;
  // A thread that waits for a loop within a loop must not take up a chunk of the outer one: it may hold a
  // lock.
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
      const std::size_t begin = chunk * grain;
      body(begin, std::min(begin + grain, count));
    });
  });
}

void set_thread_limit(unsigned threads) {
  static std::unique_ptr<tbb::global_control> control;
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads);
}

}  // namespace adamas
