#pragma once

namespace adamas::datasets {

/// The stiffened gas, p = (gamma - 1) rho e - gamma stiffness: with zero stiffness it is an ideal gas;
/// otherwise it is the simplest law of liquids and metals under shocks (Menikoff and Plohr, Rev. Mod. Phys.
/// 61, 1989). Tension is possible down to p = -stiffness.
struct StiffenedGas {
  double gamma = 1.4;    ///< above 1
  double stiffness = 0;  ///< in the unit of pressure

  /// The internal energy per volume is inverse() p + offset().
  [[nodiscard]] double inverse() const { return 1 / (gamma - 1); }
  [[nodiscard]] double offset() const { return gamma * stiffness / (gamma - 1); }
};

/// The stiffened gas whose weak shocks have the speed U = c + s u, where u is the jump of the velocity, in a
/// material of that density at rest: c^2 = gamma stiffness / density, and s = (gamma + 1) / 4 by expanding
/// its shock relations.
inline StiffenedGas gas_of_hugoniot(double density, double c, double s) {
  const double gamma = 4 * s - 1;
  return {gamma, density * c * c / gamma};
}

}  // namespace adamas::datasets
