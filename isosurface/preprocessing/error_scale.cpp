#include "isosurface/preprocessing/error_scale.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace adamas {

ErrorScale::ErrorScale(double greatest) {
  ADAMAS_ASSERT(greatest >= 0 && std::isfinite(greatest));
  constexpr int kLast = kCodes - 1;
  // Powers of two are exact: the scale is the same wherever it is computed from the same number.
  constexpr std::array<double, 4> kParts{1, 0.8408964152537145, 0.7071067811865476, 0.5946035575013605};
  for (int code = 1; code < kCodes; ++code) {
    const int steps = kLast - code;
    errors_[static_cast<std::size_t>(code)] =
        std::ldexp(greatest * kParts[static_cast<std::size_t>(steps % 4)], -(steps / 4));
  }
}

std::uint8_t ErrorScale::encode(double error) const {
  if (!(error <= errors_.back())) return kCodes - 1;
  return static_cast<std::uint8_t>(std::lower_bound(errors_.begin(), errors_.end(), error) - errors_.begin());
}

}  // namespace adamas
