#include "cli/time_left.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

namespace adamas::cli {
namespace {

constexpr double kStep = 0.1;

/// Has a stage do `part(time)` of its work until `end`, and calls check(time, seconds left) at each step.
void go_on(double end, const std::function<double(double)>& part,
           const std::function<void(double, std::optional<double>)>& check) {
  constexpr double kStart = 1000;  // any time
  TimeLeft left;
  left.start(kStart);
  for (double time = 0; time < end; time += kStep) {
    left.add(kStart + time, part(time));
    check(time, left.left(kStart + time));
  }
}

TEST(TimeLeft, IsRightOfEvenWork) {
  for (const double end : {10.0, 100.0, 3000.0}) {
    bool told = false;
    go_on(
        end, [&](double time) { return time / end; },
        [&](double time, std::optional<double> left) {
          EXPECT_TRUE(left || time <= 0.1 * end || time <= 3) << time;
          if (!left) return;
          told = true;
          EXPECT_NEAR(*left, end - time, 0.02 * (end - time) + 2 * kStep) << end << " " << time;
        });
    EXPECT_TRUE(told);
  }
}

TEST(TimeLeft, FollowsWorkThatBecomesSlower) {
  const double end = 100;
  // The rate falls by a tenth until the middle, and to nothing in the end.
  const auto part = [&](double time) { return 1 - std::pow(1 - time / end, 1.15); };
  go_on(end, part, [&](double time, std::optional<double> left) {
    if (time < 0.25 * end || time > 0.75 * end) return;
    ASSERT_TRUE(left) << time;
    EXPECT_NEAR(*left, end - time, 0.2 * (end - time) + 0.5) << time;
  });
}

TEST(TimeLeft, GoesOnBetweenRounds) {
  const double end = 50;
  const auto part = [&](double time) { return 0.2 * std::floor(5 * time / end); };
  go_on(end, part, [&](double time, std::optional<double> left) {
    if (time < 0.21 * end) return;
    ASSERT_TRUE(left) << time;
    EXPECT_NEAR(*left, end - time, 0.1 * end + 2 * kStep) << time;
  });
}

TEST(TimeLeft, SaysNothingWhereNothingIsKnown) {
  const auto none = [](double time, std::optional<double> left) { EXPECT_FALSE(left) << time; };
  // Work of which nothing is told, or too little, and the first seconds.
  go_on(
      20, [](double) { return 0.0; }, none);
  go_on(
      20, [](double time) { return 0.04 * time / 20; }, none);
  go_on(
      1.9, [](double time) { return time / 4; }, none);
  // Work that stops: after a while, what is left is not known any more.
  go_on(
      100, [](double time) { return std::min(time, 20.0) / 100; },
      [](double time, std::optional<double> left) { EXPECT_TRUE(!left || time <= 23) << time; });
}

TEST(TimeLeft, AnotherStageStartsAnew) {
  TimeLeft left;
  left.start(0);
  for (double time = 0; time < 10; time += kStep) left.add(time, time / 10);
  ASSERT_TRUE(left.left(9));
  left.start(10);
  EXPECT_FALSE(left.left(10));
  left.add(12, 0.5);
  EXPECT_FALSE(left.left(11));
  ASSERT_TRUE(left.left(12.5));
  EXPECT_NEAR(*left.left(12.5), 1.5, 1e-9);
}

TEST(TimeLeft, HasTwoDigits) {
  EXPECT_EQ(duration_text(0.2), "about 1 s");
  EXPECT_EQ(duration_text(9.4), "about 9 s");
  EXPECT_EQ(duration_text(40.2), "about 40 s");
  EXPECT_EQ(duration_text(100), "about 1.5 min");
  EXPECT_EQ(duration_text(200), "about 3.5 min");
  EXPECT_EQ(duration_text(3000), "about 50 min");
  EXPECT_EQ(duration_text(9000), "about 2.5 h");
}

}  // namespace
}  // namespace adamas::cli
