#pragma once

#include <cstddef>
#include <string>

#include "adamas/progress.h"

namespace adamas::inline core {

/// While it lives, parallel loops that its thread starts ask between their chunks whether to stop, and throw
/// Cancelled; with a stage they also report it, and which part of the loop is done. Loops within loops only
/// ask. Of several the last one counts. The progress is called by this thread alone.
class LoopProgress {
 public:
  explicit LoopProgress(Progress& progress, std::string stage = {});
  LoopProgress(const LoopProgress&) = delete;
  LoopProgress& operator=(const LoopProgress&) = delete;
  ~LoopProgress();

  /// That of this thread; null where there is none.
  static LoopProgress* of_thread();
  /// The same for that of this thread, if there is one, where the part that is done is not known: for long
  /// work that is no parallel loop.
  static void check();
  /// The same for a step of a loop, once in many.
  static void check_step(std::size_t step) {
    if (step % 65536 == 0) check();
  }
  /// Has `chunk` run, `done` of a loop being done.
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
