#include "core/base/loop_progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "core/base/parallel.h"

namespace adamas {
namespace {

/// Counts how often a loop asks, and stops it after a given number of times.
class Asked final : public Progress {
 public:
  explicit Asked(int most = 1 << 30) : most_(most) {}
  void report(std::string_view stage, double fraction) override {
    EXPECT_EQ(thread, std::this_thread::get_id());
    stages.emplace_back(stage);
    fractions.push_back(fraction);
  }
  [[nodiscard]] bool cancelled() const override {
    EXPECT_EQ(thread, std::this_thread::get_id());
    return ++count > most_;
  }
  mutable int count = 0;
  std::thread::id thread = std::this_thread::get_id();
  std::vector<std::string> stages;
  std::vector<double> fractions;

 private:
  int most_;
};

class LoopProgressOnThreads : public testing::TestWithParam<unsigned> {
 protected:
  void SetUp() override { set_thread_limit(GetParam()); }
  void TearDown() override { set_thread_limit(0); }
};

TEST_P(LoopProgressOnThreads, LoopsStopWhereTheProgressSaysSo) {
  for (const int most : {0, 1, 5}) {
    Asked asked(most);
    const LoopProgress loops(asked);
    std::atomic<int> chunks = 0;
    EXPECT_THROW(parallel_for(1 << 20, 1, [&](std::size_t) { ++chunks; }), Cancelled);
    EXPECT_EQ(asked.count, most + 1);
    EXPECT_LT(chunks, 1 << 20);
    EXPECT_TRUE(asked.stages.empty());
  }
}

TEST_P(LoopProgressOnThreads, AStageIsReportedWithThePartThatIsDone) {
  Asked asked;
  {
    const LoopProgress stage(asked, "counting", {.items = 64});
    // Nested loops ask whether to stop, but report nothing.
    parallel_for(64, 1, [&](std::size_t) { parallel_for(8, 1, [](std::size_t) {}); });
  }
  const int before = asked.count;
  parallel_for(64, 1, [](std::size_t) {});
  EXPECT_EQ(asked.count, before);
  ASSERT_FALSE(asked.fractions.empty());
  EXPECT_LE(asked.fractions.size(), 65u);
  EXPECT_GT(static_cast<std::size_t>(asked.count), asked.fractions.size());
  for (std::size_t i = 0; i < asked.fractions.size(); ++i) {
    EXPECT_EQ(asked.stages[i], "counting");
    EXPECT_GE(asked.fractions[i], i == 0 ? 0 : asked.fractions[i - 1]);
    EXPECT_LT(asked.fractions[i], 1);
  }
}

TEST_P(LoopProgressOnThreads, PartsOfAStageFollowEachOther) {
  Asked asked;
  {
    const LoopProgress stage(asked, "parts");
    parallel_for(16, 1, [](std::size_t) {});
    EXPECT_TRUE(asked.fractions.empty() || asked.fractions.back() == -1) << "no work is known";
    LoopProgress::begin_part(0.25, 64);
    parallel_for(64, 1, [](std::size_t) {});
    parallel_for(64, 1, [](std::size_t) {});  // more than was expected
    EXPECT_EQ(asked.fractions.back(), 0.25);
    LoopProgress::begin_part(0.75, 0);
    EXPECT_EQ(asked.fractions.back(), 0.25);
    LoopProgress::begin_part(1, 64);
    EXPECT_EQ(asked.fractions.back(), 0.75);
    parallel_for(64, 1, [](std::size_t) {});
  }
  // Only this thread reports, and others may do what is left after its last chunk.
  EXPECT_GE(asked.fractions.back(), GetParam() == 1 ? 0.9 : 0.75);
  EXPECT_TRUE(std::ranges::is_sorted(asked.fractions));
}

TEST_P(LoopProgressOnThreads, LoopsOfAStageShareItsPart) {
  Asked asked;
  {
    const LoopProgress stage(asked, "both", {.items = 96, .begin = 0.25, .end = 0.75});
    parallel_for(64, 1, [](std::size_t) {});
    LoopProgress::check();
    EXPECT_DOUBLE_EQ(asked.fractions.back(), 0.25 + 0.5 * 64 / 96);
    parallel_for(32, 1, [](std::size_t) {});
    LoopProgress::check();
    EXPECT_DOUBLE_EQ(asked.fractions.back(), 0.75);
    // More work than was expected is no more than the stage.
    parallel_for(32, 1, [](std::size_t) {});
    EXPECT_DOUBLE_EQ(asked.fractions.back(), 0.75);
  }
  EXPECT_DOUBLE_EQ(asked.fractions.front(), 0.25);
  EXPECT_TRUE(std::ranges::is_sorted(asked.fractions));
}

TEST_P(LoopProgressOnThreads, ItemsMayBeCountedWithoutLoops) {
  Asked asked;
  const LoopProgress stage(asked, "counting", {.items = 10, .of_loops = false});
  parallel_for(64, 1, [](std::size_t) { LoopProgress::count_items(1); });
  EXPECT_DOUBLE_EQ(asked.fractions.back(), 0);
  LoopProgress::count_items(5);
  EXPECT_DOUBLE_EQ(asked.fractions.back(), 0.5);
}

TEST_P(LoopProgressOnThreads, WorkThatIsNotKnownHasNoPart) {
  Asked asked;
  const LoopProgress stage(asked, "somehow");
  parallel_for(64, 1, [](std::size_t) {});
  ASSERT_FALSE(asked.fractions.empty());
  for (const double fraction : asked.fractions) EXPECT_LT(fraction, 0);
}

TEST_P(LoopProgressOnThreads, TheLastOneCounts) {
  Asked outer, inner;
  const LoopProgress first(outer);
  {
    const LoopProgress second(inner, "inner");
    parallel_for(16, 1, [](std::size_t) {});
  }
  EXPECT_EQ(outer.count, 0);
  EXPECT_GT(inner.count, 0);
  parallel_for(16, 1, [](std::size_t) {});
  EXPECT_GT(outer.count, 0);
}

TEST_P(LoopProgressOnThreads, NoneIsLeftOfOneThatIsNotMade) {
  Asked asked;
  const LoopProgress loops(asked);
  Asked stopped(0);
  EXPECT_THROW(LoopProgress(stopped, "stage"), Cancelled);
  EXPECT_EQ(LoopProgress::of_thread(), &loops);
}

INSTANTIATE_TEST_SUITE_P(Threads, LoopProgressOnThreads, testing::Values(1u, 2u, 4u));

}  // namespace
}  // namespace adamas
