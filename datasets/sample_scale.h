#pragma once

#include <cstddef>
#include <span>

#include "adamas/volume.h"

namespace adamas::datasets {

/// Converts values to samples: for types of whole numbers, values from `low` to `high` fill the range,
/// rounded, and values outside are clamped; float32 takes values as they are.
class SampleScale {
 public:
  /// low < high; the type is unsigned or float32.
  SampleScale(SampleType type, double low, double high);

  [[nodiscard]] SampleType type() const { return type_; }
  /// A sample stands for slope() * sample + intercept().
  [[nodiscard]] double slope() const { return slope_; }
  [[nodiscard]] double intercept() const { return intercept_; }
  /// Stores `value` as sample number `at` of an array. Returns whether it was in the range.
  bool put(double value, std::size_t at, std::span<std::byte> samples) const;

 private:
  SampleType type_;
  double slope_ = 1, intercept_ = 0;
  double greatest_ = 0;  ///< greatest sample of the type
};

}  // namespace adamas::datasets
