#include "tests/benchmarks/support/measurement.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <stdexcept>

#include "interfaces/comparison/peak_memory.h"

namespace adamas::bench {

using namespace interfaces;

namespace {

double seconds_of(clockid_t clock) {
  std::timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Does the work, sends its cost and ends the process, without the destruction of what the work has made.
[[noreturn]] void work_and_tell(const std::function<Outcome()>& work, int descriptor) {
  try {
    const PeakMemory memory;
    const double begin = seconds_of(CLOCK_MONOTONIC), processor_begin = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    Cost cost;
    cost.outcome = work();
    cost.seconds = seconds_of(CLOCK_MONOTONIC) - begin;
    cost.processor_seconds = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - processor_begin;
    cost.peak_bytes = memory.bytes();
    _exit(write(descriptor, &cost, sizeof(cost)) == ssize_t{sizeof(cost)} ? 0 : 1);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    _exit(1);
  }
}

}  // namespace

double thread_seconds() { return seconds_of(CLOCK_THREAD_CPUTIME_ID); }

Cost measure_in_child(const std::function<Outcome()>& work) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    close(ends[0]);
    work_and_tell(work, ends[1]);
  }
  close(ends[1]);
  Cost cost;
  const ssize_t size = read(ends[0], &cost, sizeof(cost));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (status != 0 || size != ssize_t{sizeof(cost)}) throw std::runtime_error("the work was not finished");
  return cost;
}

Cost median(std::vector<Cost> costs) {
  std::sort(costs.begin(), costs.end(), [](const Cost& a, const Cost& b) { return a.seconds < b.seconds; });
  return costs[costs.size() / 2];
}

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::size_t>(std::floor(part * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

void forget_pages(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_RDONLY);
  if (file < 0 || fdatasync(file) != 0 || posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED) != 0)
    throw std::runtime_error(path.string() + ": the system does not forget it");
  close(file);
}

}  // namespace adamas::bench
