#pragma once

#include <cstddef>

namespace adamas::interfaces {

/// Watches how far the resident memory of this process rises above what it is at the start of the watch.
/// There may be one watch at a time, since it resets the peak that the system keeps.
class PeakMemory {
 public:
  PeakMemory();
  /// The greatest rise so far, in bytes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::size_t before_ = 0;
};

}  // namespace adamas::interfaces
