#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

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

/// Calls `body` with 0, ..., N - 1 as compile-time constants: unlike a loop this is unrolled before the
/// compiler vectorises.
template <std::size_t N, class Body>
[[gnu::always_inline]] inline void for_each_material(const Body& body) {
  [&body]<std::size_t... K>(std::index_sequence<K...>) { (body(K), ...); }
  (std::make_index_sequence<N>{});
}

/// The indices of the variables of a cell with N materials, in conserved form (volume fractions, masses per
/// volume of the cell, momentum, total energy per volume) and in primitive form (volume fractions, each
/// material's density, velocity, pressure). The first velocity component is the one along the line that is
/// swept.
template <std::size_t N>
struct Variables {
  static constexpr std::size_t kFraction = 0;
  static constexpr std::size_t kMass = N;
  static constexpr std::size_t kDensity = N;
  static constexpr std::size_t kNormal = 2 * N;
  static constexpr std::size_t kTransverse = 2 * N + 1;
  static constexpr std::size_t kEnergy = 2 * N + 3;
  static constexpr std::size_t kPressure = 2 * N + 3;
  static constexpr std::size_t kCount = 2 * N + 4;
};

/// The number of cells that are computed side by side.
inline constexpr std::size_t kLanes = 8;

/// Conserved or primitive variables of kLanes cells.
template <std::size_t N>
using Row = std::array<std::array<double, kLanes>, Variables<N>::kCount>;

/// The laws of the materials. A mixture at one pressure p has the internal energy G p + P per volume, where G
/// and P are the means of the materials' inverse() and offset() by volume (Allaire, Clerc and Kokh 2002).
template <std::size_t N>
struct MixtureLaw {
  explicit MixtureLaw(const std::array<StiffenedGas, N>& gases) {
    for (std::size_t k = 0; k < N; ++k) {
      inverse[k] = gases[k].inverse();
      offset[k] = gases[k].offset();
    }
  }
  std::array<double, N> inverse{}, offset{};
};

/// Density, G and P of a mixture.
struct MixtureMeans {
  double density = 0, inverse = 0, offset = 0;

  /// The product rho c^2, where c is the speed of sound at constant volume fractions.
  [[nodiscard]] double stiffness_at(double pressure) const {
    return ((inverse + 1) * pressure + offset) / inverse;
  }
};

}  // namespace adamas::datasets
