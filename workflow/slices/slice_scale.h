#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/picture/slice_picture.h"

namespace adamas::workflow {

/// The common properties of pictures of the steps of a series, so that they can be compared and be frames of
/// a film: one range of values, one legend, one title.
class SliceScale {
 public:
  explicit SliceScale(std::string title) : title_(std::move(title)) {}

  /// Adds the values and the materials of a step's picture.
  void add(const picture::SlicePicture& picture);
  /// Gives a step's picture the common range, where it has none of its own, and the common legend and title;
  /// its first panel gets the time and the number of the step.
  void apply(std::size_t step, double time, picture::SlicePicture& picture) const;
  /// Returns the range of all values that were shown; none where there were none.
  [[nodiscard]] const std::optional<picture::ValueRange>& range() const { return range_; }

 private:
  std::string title_;
  std::optional<picture::ValueRange> range_;
  std::vector<picture::LegendEntry> materials_;
};

/// Puts the time and the number of a step before the title of the first panel.
void add_step_title(double time, std::size_t step, picture::SlicePicture& picture);

/// The default number of frames of a film per second.
inline constexpr double kFrameRate = 10;

}  // namespace adamas::workflow
