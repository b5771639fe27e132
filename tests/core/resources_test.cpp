#include "adamas/resources.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <ctime>
#include <vector>

namespace adamas {
namespace {

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Computes until this thread has taken so many processor seconds.
void take(double seconds) {
  const double end = thread_seconds() + seconds;
  while (thread_seconds() < end) {
  }
}

/// The system may count user and system time in ticks of some milliseconds.
constexpr double kTick = 0.02;

TEST(Resources, ProcessorSecondsAreThoseThatAThreadTook) {
  const double before = processor_seconds();
  take(0.1);
  EXPECT_GE(processor_seconds() - before, 0.1 - kTick);
}

TEST(Resources, ProcessorSecondsHaveThoseOfProgramsThatHaveEnded) {
  const double before = processor_seconds();
  const pid_t child = fork();
  if (child == 0) {
    take(0.1);
    _exit(0);
  }
  ASSERT_GT(child, 0);
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  EXPECT_GE(processor_seconds() - before, 0.1 - kTick);
}

TEST(Resources, PeakMemoryHoldsWhatWasTouched) {
  constexpr std::size_t kBytes = std::size_t{64} << 20;
  { const std::vector<char> touched(kBytes, 1); }
  EXPECT_GE(peak_memory_bytes(), kBytes);
}

}  // namespace
}  // namespace adamas
