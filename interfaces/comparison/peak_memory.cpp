#include "interfaces/comparison/peak_memory.h"

#include <malloc.h>

#include <fstream>
#include <string>

namespace adamas::interfaces {

namespace {

/// Returns the value, in bytes, of a line "NAME: 1234 kB" of this process's status; 0 if there is none.
std::size_t status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(name)) return 1024 * std::stoull(line.substr(name.size()));
  }
  return 0;
}

}  // namespace

PeakMemory::PeakMemory() {
  // Free memory that the allocator still holds would hide a part of the memory needed.
  ::malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
  before_ = status_bytes("VmRSS:");
}

std::size_t PeakMemory::bytes() const {
  const std::size_t peak = status_bytes("VmHWM:");
  return peak > before_ ? peak - before_ : 0;
}

}  // namespace adamas::interfaces
