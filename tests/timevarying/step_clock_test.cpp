#include "timevarying/step_clock.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace adamas {

using namespace timevarying;

namespace {

using Steps = std::vector<std::uint32_t>;

StepClock clock_of(std::uint32_t steps, Repeat repeat, bool is_backward = false) {
  StepClock clock;
  clock.set_steps(steps);
  clock.pace() = {4, repeat, is_backward, 0.5};
  return clock;
}

/// Returns the steps that are shown one after another, beginning at `from`, when each is ready in time.
Steps played(StepClock clock, std::uint32_t from, std::size_t most) {
  Steps shown{clock.play(from)};
  for (int tick = 0; tick < 1000 && shown.size() < most && clock.is_playing(); ++tick) {
    const std::uint32_t step = clock.advance(shown.back(), 0.0625, true);
    if (step != shown.back()) shown.push_back(step);
  }
  return shown;
}

TEST(StepClock, PlaysOnceRoundAndThereAndBack) {
  EXPECT_EQ(played(clock_of(4, Repeat::kOnce), 1, 9), (Steps{1, 2, 3}));
  EXPECT_EQ(played(clock_of(4, Repeat::kOnce), 3, 9), (Steps{0, 1, 2, 3})) << "from the end: anew";
  EXPECT_EQ(played(clock_of(4, Repeat::kOnce, true), 2, 9), (Steps{2, 1, 0}));
  EXPECT_EQ(played(clock_of(4, Repeat::kOnce, true), 0, 9), (Steps{3, 2, 1, 0}));
  EXPECT_EQ(played(clock_of(3, Repeat::kLoop), 1, 6), (Steps{1, 2, 0, 1, 2, 0}));
  EXPECT_EQ(played(clock_of(3, Repeat::kLoop, true), 1, 6), (Steps{1, 0, 2, 1, 0, 2}));
  EXPECT_EQ(played(clock_of(3, Repeat::kThereAndBack), 1, 7), (Steps{1, 2, 1, 0, 1, 2, 1}));
  EXPECT_EQ(played(clock_of(2, Repeat::kThereAndBack, true), 1, 4), (Steps{1, 0, 1, 0}));
  EXPECT_EQ(played(clock_of(1, Repeat::kThereAndBack), 0, 3), (Steps{0}));
  EXPECT_EQ(played(clock_of(1, Repeat::kLoop), 0, 3), (Steps{0}));
}

TEST(StepClock, FollowingStepsAreThoseThatArePlayed) {
  for (const Repeat repeat : {Repeat::kOnce, Repeat::kLoop, Repeat::kThereAndBack}) {
    for (const bool is_backward : {false, true}) {
      for (std::uint32_t steps = 1; steps < 7; ++steps) {
        for (std::uint32_t from = 0; from < steps; ++from) {
          const StepClock clock = clock_of(steps, repeat, is_backward);
          Steps expected;
          const bool is_end = is_backward ? from == 0 : from + 1 == steps;
          const Steps all = repeat == Repeat::kOnce && is_end ? Steps{from} : played(clock, from, 4);
          for (std::size_t n = 1; n < all.size(); ++n) {
            if (all[n] != from && std::ranges::find(expected, all[n]) == expected.end())
              expected.push_back(all[n]);
          }
          EXPECT_EQ(clock.following(from, 3), expected) << steps << " from " << from;
        }
      }
    }
  }
}

TEST(StepClock, WaitsForWhatIsNotThereYetButNotForEver) {
  StepClock clock = clock_of(5, Repeat::kLoop);
  EXPECT_EQ(clock.advance(2, 100, true), 2u) << "it is not playing";
  clock.play(2);
  EXPECT_EQ(clock.advance(2, 0.24, true), 2u);
  EXPECT_EQ(clock.advance(2, 0.02, true), 3u) << "a quarter of a second";
  EXPECT_EQ(clock.advance(3, 0.25, false), 3u);
  EXPECT_EQ(clock.advance(3, 0.4, false), 3u);
  EXPECT_EQ(clock.advance(3, 0.01, true), 4u) << "as soon as it is there";
  EXPECT_EQ(clock.advance(4, 0.2, true), 4u) << "and then it has its time";
  clock.play(4);
  EXPECT_EQ(clock.advance(4, 0.74, false), 4u);
  EXPECT_EQ(clock.advance(4, 0.02, false), 0u) << "after half a second, coarser";
  clock.pause();
  EXPECT_EQ(clock.advance(0, 10, true), 0u);
}

TEST(StepClock, KeepsItsPaceHoweverUnevenFramesAreAndLeavesNoStepOut) {
  StepClock clock = clock_of(1000, Repeat::kOnce);
  std::uint32_t step = clock.play(0);
  double passed = 0;
  for (int frame = 0; frame < 400; ++frame) {
    const double seconds = 0.01 + 0.02 * (frame % 7);
    passed += seconds;
    const std::uint32_t next = clock.advance(step, seconds, true);
    ASSERT_LE(next, step + 1);
    step = next;
  }
  EXPECT_NEAR(step, 4 * passed, 1);
  const std::uint32_t before = step;
  // Each frame lasts a second and shows one more step; no further steps follow afterwards.
  for (int frame = 0; frame < 10; ++frame) step = clock.advance(step, 1, true);
  EXPECT_EQ(step, before + 10);
  EXPECT_EQ(clock.advance(step, 0.1, true), step);
}

}  // namespace
}  // namespace adamas
