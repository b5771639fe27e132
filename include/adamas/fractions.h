#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// A standard deviation that is known, or that is read off volume fractions.
struct StandardDeviation {
  std::optional<double> value{};  ///< none: it is read off the fractions

  constexpr StandardDeviation() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a number is a standard deviation that is known.
  constexpr StandardDeviation(double known) : value(known) {}
};

/// What is known of volume fractions before interfaces are reconstructed from them
/// (docs/blurred_fractions.md). Where any of these options is given, labels and given interfaces are refused,
/// also where it asks for what is the default.
struct FractionOptions {
  static constexpr double kMostBlur = 4, kMostError = 0.5;
  /// The standard deviation, in cells, of what has blurred the fractions: from 0 for sharp ones to 4. Without
  /// it, it is read off the fractions, place by place.
  std::optional<StandardDeviation> blur{};
  /// The standard deviation of errors of fractions, from 0 to 0.5. Without it, it is read off the fractions.
  std::optional<StandardDeviation> error{};
  /// Draw islands round fractions that no interface explains, too, in place of counting them as dispersed.
  bool keep_dispersed = false;

  /// The blur and the error where they are known; none where they are read off the fractions.
  [[nodiscard]] std::optional<double> known_blur() const { return blur ? blur->value : std::nullopt; }
  [[nodiscard]] std::optional<double> known_error() const { return error ? error->value : std::nullopt; }
  /// Returns the name, on the command line, of the first option given; empty where none is given.
  [[nodiscard]] std::string option() const;
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
