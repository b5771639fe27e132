#include "cli/memory_limit.h"

#include <sys/resource.h>

#include "adamas/progress.h"
#include "adamas/resources.h"
#include "cli/option_values.h"

namespace adamas::cli {

namespace {

/// What is reserved besides: the program with its libraries, and the stack of each thread.
constexpr std::size_t kProgram = std::size_t{64} << 20, kStack = std::size_t{8} << 20;

/// Returns whether the process was started with a limit of its address space that is less.
bool has_less_address_space(std::size_t bytes) {
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  return limit.rlim_cur != RLIM_INFINITY && limit.rlim_cur < bytes;
}

}  // namespace

void add_memory_limit(const Command& command, std::optional<std::size_t>& bytes) {
  command.add_value(
      "--memory", "SIZE",
      "The memory that may be taken: bytes, or with K, M or G; what takes more ends with a line "
      "that says how much (default half of what is free)",
      bytes, parse_size);
}

std::size_t begin_memory_limit(const std::optional<std::size_t>& wanted, Session& session) {
  const std::size_t bytes = wanted ? *wanted : available_memory_bytes() / 2;
  if (bytes == 0 || has_less_address_space(bytes)) return bytes;
  session.memory = bytes;
  limit_memory(bytes + kProgram + kStack * thread_limit());
  return bytes;
}

}  // namespace adamas::cli
