#pragma once

#include <cstddef>

namespace adamas::interfaces {

/// Measures the greatest rise of the resident memory of this process since the construction of this object.
/// There may be one such object at a time, since it resets the peak that the system records.
class PeakMemory {
 public:
  PeakMemory();
  /// Returns the greatest rise so far, in bytes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::size_t before_ = 0;
};

}  // namespace adamas::interfaces
