#pragma once

#include <chrono>

#include "adamas/resources.h"

namespace adamas::inline core {

/// Measures time since its construction.
class Stopwatch {
 public:
  /// Returns seconds of the clock.
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// Returns processor seconds of all threads, and of programs that were started and have ended.
  [[nodiscard]] double processor_seconds() const { return adamas::processor_seconds() - processor_start_; }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double processor_start_ = adamas::processor_seconds();
};

}  // namespace adamas::inline core
