#include "adamas/resources.h"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>

#include "core/base/sanitizers.h"

namespace adamas {

namespace {

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double processor_seconds_of(int who) {
  rusage usage{};
  getrusage(who, &usage);
  return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

/// Returns the number in a file that has nothing else, such as a limit of a control group.
std::optional<std::size_t> number_in(const char* path) {
  std::ifstream file(path);
  std::size_t number = 0;
  return file >> number ? std::optional(number) : std::nullopt;
}

/// Returns what the limit of this control group leaves; nothing where there is no limit.
std::optional<std::size_t> left_in_group(const char* limit, const char* used) {
  const auto most = number_in(limit), now = number_in(used);
  if (!most || !now) return {};
  return *most - std::min(*most, *now);
}

}  // namespace

double processor_seconds() {
  return processor_seconds_of(RUSAGE_SELF) + processor_seconds_of(RUSAGE_CHILDREN);
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

std::size_t available_memory_bytes() {
  std::size_t available = 0;
  std::ifstream file("/proc/meminfo");
  for (std::string name, unit; file >> name;) {
    std::size_t kibibytes = 0;
    file >> kibibytes;
    std::getline(file, unit);
    if (name == "MemAvailable:") available = kibibytes * 1024;
  }
  if (available == 0) return 0;
  for (const auto& left : {left_in_group("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"),
                           left_in_group("/sys/fs/cgroup/memory/memory.limit_in_bytes",
                                         "/sys/fs/cgroup/memory/memory.usage_in_bytes")}) {
    if (left) available = std::min(available, *left);
  }
  return available;
}

void limit_memory(std::size_t bytes) {
  if (ADAMAS_HAS_SHADOW_MEMORY) return;
  // Data of the process, and not its address space, which has files and what is only reserved as well.
  rlimit limit{};
  getrlimit(RLIMIT_DATA, &limit);
  limit.rlim_cur = bytes == 0 ? limit.rlim_max : std::min<rlim_t>(bytes, limit.rlim_max);
  setrlimit(RLIMIT_DATA, &limit);
}

}  // namespace adamas
