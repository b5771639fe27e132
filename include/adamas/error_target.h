#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// A wanted error: in the unit of the quantity, as a part of a whole (the domain's diagonal, the range of a
/// field), or in voxels of the input's grid.
struct ErrorTarget {
  enum class Unit : std::uint8_t { kAbsolute, kPart, kVoxels };
  double value = 0;  ///< 0.01 for 1%
  Unit unit = Unit::kAbsolute;

  constexpr ErrorTarget() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a number is an absolute error.
  constexpr ErrorTarget(double number, Unit its_unit = Unit::kAbsolute) : value(number), unit(its_unit) {}

  /// Returns the error in the unit of `whole` and `voxel`; `voxel` is 0 where there is no grid.
  [[nodiscard]] double absolute(double whole, double voxel = 0) const;
  /// Returns the error as it is written on the command line: "0.15", "1%", "0.5voxels".
  [[nodiscard]] std::string text() const;
  bool operator==(const ErrorTarget&) const = default;
};

/// Reads "0.15", "1%" or, with `voxels`, "0.5voxels". The result is empty where the text is something else,
/// or the number is not finite.
std::optional<ErrorTarget> to_error_target(const std::string& text, bool voxels = false);
/// Reads the same texts. Throws Error (kUsage), which names the option, where the number is not positive and
/// finite.
ErrorTarget parse_error_target(const std::string& option, const std::string& text, bool voxels = false);

}  // namespace adamas
