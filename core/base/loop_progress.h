#pragma once

#include <cstddef>
#include <string>

#include "adamas/progress.h"

namespace adamas::inline core {

/// The work of a stage: how many items its loops have, all together, and the part of the stage that these
/// loops are. Items of different loops count as the same work.
struct StageWork {
  double items = 0;           ///< 0: not known; the part that is done is not reported then
  bool of_loops = true;       ///< whether items of loops count, besides those of count_items()
  double begin = 0, end = 1;  ///< the parts of the stage that are done before and after these loops
};

/// Has parallel loops, while it lives, ask a Progress between their chunks whether to stop; they throw
/// Cancelled then. With a stage they also report the stage and, where its work is known, the part of it that
/// is done, which never falls. It holds for the loops that its thread starts; nested loops only ask. Where a
/// thread has several of these objects, the last one counts. The progress is called by this thread alone.
class LoopProgress {
 public:
  explicit LoopProgress(Progress& progress, std::string stage = {}, StageWork work = {});
  LoopProgress(const LoopProgress&) = delete;
  LoopProgress& operator=(const LoopProgress&) = delete;
  ~LoopProgress();

  /// The object that counts for this thread; null where there is none.
  static LoopProgress* of_thread();
  /// Checks for cancellation in long work that is no parallel loop, and reports the stage. Does nothing where
  /// this thread has no such object.
  static void check();
  /// Calls check() once in 65536 steps of a loop.
  static void check_step(std::size_t step) {
    if (step % 65536 == 0) check();
  }
  /// Begins a part of the stage, up to `end` of it: so many items of loops, or 0 if that is not known. Does
  /// nothing where this thread has no stage.
  static void begin_part(double end, double items);
  /// Counts items that are done otherwise than by an iteration of a loop.
  static void count_items(double items);
  /// Runs a chunk of a loop of `items` items of which the part `done` is done.
  template <class Chunk>
  void run(double items, double done, Chunk&& chunk) {
    if (depth_ == 0 && work_.of_loops) loop_items_ = items * done;
    step();
    const Within within(depth_);
    chunk();
  }
  /// Counts the items of a loop that has ended.
  void end_loop(double items) {
    if (depth_ > 0 || !work_.of_loops) return;
    items_ += items;
    loop_items_ = 0;
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
  void step();
  [[nodiscard]] double part_done();

  Progress& progress_;
  std::string stage_;
  StageWork work_;
  LoopProgress* before_;
  double items_ = 0;       ///< items of loops that have ended
  double loop_items_ = 0;  ///< items of the present loop that are done
  double part_end_ = 0;    ///< the end of the present part of the stage
  double done_ = 0;        ///< the greatest part of the work that was reported
  int depth_ = 0;
};

}  // namespace adamas::inline core
