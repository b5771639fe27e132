#include "datasets/flow/shocked_interface.h"

#include <cmath>

#include "core/base/assert.h"

namespace adamas::datasets {

namespace {

/// The gas before a shock.
struct Ahead {
  double gamma, density, pressure;

  /// Its gain in velocity across a shock to a greater pressure (Toro's book, 3.1.3).
  [[nodiscard]] double pushed(double behind) const {
    return (behind - pressure) * std::sqrt(2 / (density * ((gamma + 1) * behind + (gamma - 1) * pressure)));
  }
  [[nodiscard]] double density_behind(double behind) const {
    return density * ((gamma + 1) * behind + (gamma - 1) * pressure) /
           ((gamma - 1) * behind + (gamma + 1) * pressure);
  }
  /// The shock's speed relative to the gas.
  [[nodiscard]] double shock_speed(double behind) const {
    return std::sqrt(((gamma + 1) * behind + (gamma - 1) * pressure) / (2 * density));
  }
};

}  // namespace

ShockedInterface strike_interface(const RestingGas& first, const RestingGas& second, double pressure,
                                  double mach) {
  ADAMAS_ASSERT(mach > 1 && first.gas.stiffness == 0 && second.gas.stiffness == 0);
  const Ahead near{first.gas.gamma, first.density, pressure}, far{second.gas.gamma, second.density, pressure};
  ShockedInterface result;
  result.shock_pressure = pressure * (1 + 2 * near.gamma / (near.gamma + 1) * (mach * mach - 1));
  result.shock_density = near.density_behind(result.shock_pressure);
  result.shock_velocity = near.pushed(result.shock_pressure);
  result.shock_speed = near.shock_speed(result.shock_pressure);
  // At the wanted pressure both gases have one velocity: a greater pressure slows the first gas and
  // accelerates the second one.
  const Ahead back{near.gamma, result.shock_density, result.shock_pressure};
  const auto is_too_low = [&](double p) { return result.shock_velocity - back.pushed(p) > far.pushed(p); };
  double low = result.shock_pressure, high = 2 * low;
  ADAMAS_ASSERT(is_too_low(low));
  while (is_too_low(high)) high *= 2;
  for (double middle = 0.5 * (low + high); middle > low && middle < high; middle = 0.5 * (low + high)) {
    (is_too_low(middle) ? low : high) = middle;
  }
  result.pressure = low;
  result.velocity = far.pushed(low);
  result.reflected_density = back.density_behind(low);
  result.reflected_speed = result.shock_velocity - back.shock_speed(low);
  result.through_density = far.density_behind(low);
  result.through_speed = far.shock_speed(low);
  return result;
}

}  // namespace adamas::datasets
