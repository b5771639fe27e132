#pragma once

#include <cstddef>
#include <string>

#include "adamas/progress.h"

namespace adamas::inline core {

/// Has parallel loops, while it lives, ask a Progress between their chunks whether to stop; they throw
/// Cancelled then. With a stage they also report the stage and the part of the loop that is done. It holds
/// for the loops that its thread starts; nested loops only ask. Where a thread has several of these objects,
/// the last one counts. The progress is called by this thread alone.
class LoopProgress {
 public:
  explicit LoopProgress(Progress& progress, std::string stage = {});
  LoopProgress(const LoopProgress&) = delete;
  LoopProgress& operator=(const LoopProgress&) = delete;
  ~LoopProgress();

  /// The object that counts for this thread; null where there is none.
  static LoopProgress* of_thread();
  /// Checks for cancellation in long work that is no parallel loop, and reports the stage without a part that
  /// is done. Does nothing where this thread has no such object.
  static void check();
  /// Calls check() once in 65536 steps of a loop.
  static void check_step(std::size_t step) {
    if (step % 65536 == 0) check();
  }
  /// Runs a chunk of a loop of which the part `done` is done.
  template <class Chunk>
  void run(double done, Chunk&& chunk) {
    step(done);
    const Within within(depth_);
    chunk();
  }

 private:
  /// Counts the loops that the thread is in.
  struct Within {
    explicit Within(int& count) : depth(count) { ++depth; }
    Within(const Within&) = delete;
    Within& operator=(const Within&) = delete;
    ~Within() { --depth; }
    int& depth;
  };
  void step(double done);

  Progress& progress_;
  std::string stage_;
  LoopProgress* before_;
  int depth_ = 0;
};

}  // namespace adamas::inline core
