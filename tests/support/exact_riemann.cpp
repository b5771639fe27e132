#include "exact_riemann.h"

#include <algorithm>
#include <cmath>

namespace adamas::test {

namespace {

double sound(const GasState& s) { return std::sqrt(s.gamma * (s.pressure + s.stiffness) / s.density); }

/// Returns the change of velocity across the wave between a state and the pressure p behind it.
double velocity_change(const GasState& s, double p) {
  if (p > s.pressure) {
    const double a = 2 / ((s.gamma + 1) * s.density);
    const double b = (s.gamma - 1) / (s.gamma + 1) * (s.pressure + s.stiffness);
    return (p - s.pressure) * std::sqrt(a / (p + s.stiffness + b));
  }
  const double ratio = (p + s.stiffness) / (s.pressure + s.stiffness);
  return 2 * sound(s) / (s.gamma - 1) * (std::pow(ratio, (s.gamma - 1) / (2 * s.gamma)) - 1);
}

/// Returns the state on one side, as if its wave ran to the right; `speed` is x / t.
GasState side(const GasState& s, double pressure, double velocity, double speed) {
  GasState star = s;
  star.pressure = pressure;
  star.velocity = velocity;
  const double ratio = (pressure + s.stiffness) / (s.pressure + s.stiffness);
  if (pressure > s.pressure) {
    const double k = (s.gamma - 1) / (s.gamma + 1);
    star.density = s.density * (ratio + k) / (k * ratio + 1);
    const double shock = s.velocity + sound(s) * std::sqrt((s.gamma + 1) / (2 * s.gamma) * ratio +
                                                           (s.gamma - 1) / (2 * s.gamma));
    return speed > shock ? s : star;
  }
  star.density = s.density * std::pow(ratio, 1 / s.gamma);
  if (speed > s.velocity + sound(s)) return s;
  if (speed < velocity + sound(star)) return star;
  GasState fan = s;
  const double c = 2 / (s.gamma + 1) * (sound(s) - (s.gamma - 1) / 2 * (s.velocity - speed));
  fan.velocity = speed - c;
  const double thinning = std::pow(c / sound(s), 2 / (s.gamma - 1));
  fan.density = s.density * thinning;
  fan.pressure = (s.pressure + s.stiffness) * std::pow(thinning, s.gamma) - s.stiffness;
  return fan;
}

GasState mirrored(GasState s) {
  s.velocity = -s.velocity;
  return s;
}

}  // namespace

ExactRiemann::ExactRiemann(const GasState& left, const GasState& right) : left_(left), right_(right) {
  const auto excess = [&](double p) {
    return velocity_change(left, p) + velocity_change(right, p) + right.velocity - left.velocity;
  };
  // The excess grows with the pressure, so the pressure is found by bisection. It starts where one of the
  // gases has a speed of sound of 0.
  double low = -std::min(left.stiffness, right.stiffness);
  double high = std::max({left.pressure, right.pressure, 1e-300});
  while (excess(high) < 0) high = 2 * high + std::max(left.stiffness, right.stiffness);
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) < 0 ? low : high) = middle;
  }
  pressure_ = 0.5 * (low + high);
  velocity_ = 0.5 * (left.velocity + right.velocity) +
              0.5 * (velocity_change(right, pressure_) - velocity_change(left, pressure_));
}

GasState ExactRiemann::at(double speed) const {
  if (speed > velocity_) return side(right_, pressure_, velocity_, speed);
  return mirrored(side(mirrored(left_), pressure_, -velocity_, -speed));
}

}  // namespace adamas::test
