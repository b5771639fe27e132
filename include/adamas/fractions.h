#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// Known properties of volume fractions, which reconstruction takes into account (docs/blurred_fractions.md).
struct FractionOptions {
  static constexpr double kMostBlur = 4, kMostError = 0.5;
  /// The standard deviation, in cells, of what has blurred the fractions: from 0 for sharp ones to 4. None:
  /// it is estimated from the fractions, place by place.
  std::optional<double> blur{};
  /// The standard deviation of errors of fractions, from 0 to 0.5. None: it is estimated from the fractions.
  std::optional<double> error{};
  /// Draw islands round fractions that no interface explains, too, in place of counting them as dispersed.
  bool keep_dispersed = false;
};

/// Properties that were found in volume fractions.
struct FractionFindings {
  /// Widths of blurred steps of fractions: the standard deviation of the normal distribution that a step
  /// looks like, in cells, that of the cell itself included.
  double blur_median = 0, blur_greatest = 0;
  double blur_share = 0;      ///< the share of mixed cells that are blurred
  double fraction_error = 0;  ///< the standard deviation of errors of fractions, estimated
  std::size_t mixed_cells = 0;
  /// Mixed cells whose fractions differ by more than the tolerance, in a material, from what the interfaces,
  /// blurred as the cells are, would give; and how far at most.
  std::size_t cells_off = 0;
  double tolerance = 0, greatest_difference = 0;
  /// Volume of each material that no interface explains, in the input's order.
  std::vector<double> dispersed{};
  /// The area of all interfaces, and of those where the greatest fraction changes from one material to
  /// another.
  double area = 0, area_of_fractions = 0;
};

}  // namespace adamas
