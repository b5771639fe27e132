#include "adamas/error_target.h"

#include "adamas/text.h"
#include "core/base/error.h"

namespace adamas {

double ErrorTarget::absolute(double whole, double voxel) const {
  switch (unit) {
    case Unit::kPart:
      return value * whole;
    case Unit::kVoxels:
      return value * voxel;
    case Unit::kAbsolute:
      break;
  }
  return value;
}

std::string ErrorTarget::text() const {
  if (unit == Unit::kPart) return fmt::format("{:.6g}%", 100 * value);
  return fmt::format("{:.6g}{}", value, unit == Unit::kVoxels ? "voxels" : "");
}

std::optional<ErrorTarget> to_error_target(const std::string& text, bool voxels) {
  const bool relative = !text.empty() && text.back() == '%';
  const auto in_voxels = voxels ? before_voxels(text) : std::nullopt;
  const auto value = to_number(in_voxels ? *in_voxels : relative ? text.substr(0, text.size() - 1) : text);
  if (!value) return {};
  using Unit = ErrorTarget::Unit;
  if (in_voxels) return ErrorTarget{*value, Unit::kVoxels};
  return relative ? ErrorTarget{*value / 100, Unit::kPart} : ErrorTarget{*value, Unit::kAbsolute};
}

ErrorTarget parse_error_target(const std::string& option, const std::string& text, bool voxels) {
  const std::optional<ErrorTarget> error = to_error_target(text, voxels);
  if (!error || !(error->value > 0)) {
    wrong_usage("{}: expected a positive error as 0.15{} 1%, found '{}'", option,
                voxels ? ", 0.5voxels or" : " or", text);
  }
  return *error;
}

}  // namespace adamas
