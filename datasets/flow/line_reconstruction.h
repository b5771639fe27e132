#pragma once

#include <algorithm>
#include <cmath>

#include "datasets/flow/mixture.h"
#include "datasets/flow/vectorisation.h"

namespace adamas::datasets {

/// The smaller of two differences with equal sign, else zero.
inline double minmod(double a, double b) {
  const double least = std::min(std::abs(a), std::abs(b));
  return a * b > 0 ? std::copysign(least, a) : 0.0;
}

/// The slope by van Leer's monotonised central difference: total variation diminishing, and of second order
/// on the flanks of smooth extrema.
inline double central_slope(double a, double b) {
  const double least = std::min(2 * std::min(std::abs(a), std::abs(b)), 0.5 * std::abs(a + b));
  return a * b > 0 ? std::copysign(least, a) : 0.0;
}

/// The greatest difference between the value at a cell's end and the cell's own, towards the cell beyond that
/// end: `beyond` is the difference to that cell, `behind` that on the other side. The value is as close as
/// possible to the one downstream, so that interfaces stay within two or three cells, but not so close that
/// the cell would overshoot the one upstream while `courant` of it flows out (Kokh and Lagoutiere 2010).
inline double sharp_reach(double beyond, double behind, double courant) {
  return minmod(beyond, behind * ((1 - courant) / courant));
}

/// Converts conserved to primitive variables.
template <std::size_t N>
ADAMAS_VECTOR_CLONES void to_primitive(const MixtureLaw<N>& law, const Row<N>& q, Row<N>& w) {
  using V = Variables<N>;
  // This is the least number whose inverse is finite: an absent material has density zero.
  constexpr double kTiny = 1e-300;
  ADAMAS_INDEPENDENT_LANES
  for (std::size_t l = 0; l < kLanes; ++l) {
    MixtureMeans mean;
    for_each_material<N>([&](std::size_t k) __attribute__((always_inline)) {
      const double fraction = q[V::kFraction + k][l], mass = q[V::kMass + k][l];
      mean.density += mass;
      mean.inverse += fraction * law.inverse[k];
      mean.offset += fraction * law.offset[k];
      w[V::kFraction + k][l] = fraction;
      w[V::kDensity + k][l] = mass / std::max(fraction, kTiny);
    });
    const double volume = 1 / mean.density;
    const double a = q[V::kNormal][l] * volume, b = q[V::kTransverse][l] * volume,
                 c = q[V::kTransverse + 1][l] * volume;
    w[V::kNormal][l] = a;
    w[V::kTransverse][l] = b;
    w[V::kTransverse + 1][l] = c;
    const double internal = q[V::kEnergy][l] - 0.5 * mean.density * (a * a + (b * b + c * c));
    w[V::kPressure][l] = (internal - mean.offset) / mean.inverse;
  }
}

/// Primitive variables at a cell's two ends after half a step: they are linear in the cell and advanced by
/// the equations in primitive form (MUSCL-Hancock, see Toro's book, 14.4). `half` is half the step over the
/// size of a cell. If `order` is zero, or an end would have a state without a speed of sound, both ends get
/// the cell's own values.
template <std::size_t N>
ADAMAS_VECTOR_CLONES void reconstruct(const MixtureLaw<N>& law, const Row<N>& before, const Row<N>& w,
                                      const Row<N>& after, double half,
                                      const std::array<double, kLanes>& order, Row<N>& low, Row<N>& high) {
  using V = Variables<N>;
  // Faces may move faster than the cell between them.
  constexpr double kLeastCourant = 0.2, kMargin = 1.2;
  ADAMAS_INDEPENDENT_LANES
  for (std::size_t l = 0; l < kLanes; ++l) {
    const auto differences = [&](std::size_t v) __attribute__((always_inline)) {
      return std::pair(w[v][l] - before[v][l], after[v][l] - w[v][l]);
    };
    const auto slope = [&](std::size_t v) __attribute__((always_inline)) {
      const auto [a, b] = differences(v);
      return central_slope(a, b);
    };
    const double velocity = w[V::kNormal][l], pressure = w[V::kPressure][l];
    const double courant = std::min(1.0, std::max(kLeastCourant, kMargin * 2 * half * std::abs(velocity)));
    const double d_velocity = slope(V::kNormal), d_pressure = slope(V::kPressure);
    std::array<double, N> fraction_low, fraction_high, density_low, density_high;
    MixtureMeans mean;
    double sum_low = 0, sum_high = 0;
    for_each_material<N>([&](std::size_t k) __attribute__((always_inline)) {
      const double fraction = w[V::kFraction + k][l], density = w[V::kDensity + k][l];
      const auto [a, b] = differences(V::kFraction + k);
      const double d_density = slope(V::kDensity + k);
      fraction_low[k] = fraction - sharp_reach(a, b, courant);
      fraction_high[k] = fraction + sharp_reach(b, a, courant);
      sum_low += fraction_low[k];
      sum_high += fraction_high[k];
      const double thinned = density - half * (velocity * d_density + density * d_velocity);
      density_low[k] = thinned - 0.5 * d_density;
      density_high[k] = thinned + 0.5 * d_density;
      mean.density += fraction * density;
      mean.inverse += fraction * law.inverse[k];
      mean.offset += fraction * law.offset[k];
    });
    const double stiffness = mean.stiffness_at(pressure);
    const double p = pressure - half * (velocity * d_pressure + stiffness * d_velocity);
    const double p_low = p - 0.5 * d_pressure, p_high = p + 0.5 * d_pressure;
    // Limited slopes of three materials do not add up to zero, so the fractions are scaled.
    const double scale_low = 1 / sum_low, scale_high = 1 / sum_high;
    MixtureMeans at_low, at_high;
    double least = 1;
    for_each_material<N>([&](std::size_t k) __attribute__((always_inline)) {
      fraction_low[k] *= scale_low;
      fraction_high[k] *= scale_high;
      at_low.inverse += fraction_low[k] * law.inverse[k];
      at_high.inverse += fraction_high[k] * law.inverse[k];
      at_low.offset += fraction_low[k] * law.offset[k];
      at_high.offset += fraction_high[k] * law.offset[k];
      at_low.density += fraction_low[k] * density_low[k];
      at_high.density += fraction_high[k] * density_high[k];
      least = std::min(least, std::min(std::min(fraction_low[k], fraction_high[k]),
                                       std::min(density_low[k], density_high[k])));
    });
    // The pressure, measured from where the speed of sound vanishes, must not fall below a tenth of the
    // cell's.
    constexpr double kLeast = 0.1;
    const double room = kLeast * stiffness;
    const double spare =
        std::min(std::min(at_low.stiffness_at(p_low) - room, at_high.stiffness_at(p_high) - room),
                 std::min(at_low.density, at_high.density) - kLeast * mean.density);
    const bool good = order[l] > 0 && least >= 0 && spare > 0;
    for_each_material<N>([&](std::size_t k) __attribute__((always_inline)) {
      const double fraction = w[V::kFraction + k][l], density = w[V::kDensity + k][l];
      low[V::kFraction + k][l] = good ? fraction_low[k] : fraction;
      high[V::kFraction + k][l] = good ? fraction_high[k] : fraction;
      low[V::kDensity + k][l] = good ? density_low[k] : density;
      high[V::kDensity + k][l] = good ? density_high[k] : density;
    });
    const double u = velocity - half * (velocity * d_velocity + d_pressure / mean.density);
    low[V::kNormal][l] = good ? u - 0.5 * d_velocity : velocity;
    high[V::kNormal][l] = good ? u + 0.5 * d_velocity : velocity;
    for (const std::size_t v : {V::kTransverse, V::kTransverse + 1}) {
      const double d = slope(v), moved = w[v][l] - half * velocity * d;
      low[v][l] = good ? moved - 0.5 * d : w[v][l];
      high[v][l] = good ? moved + 0.5 * d : w[v][l];
    }
    low[V::kPressure][l] = good ? p_low : pressure;
    high[V::kPressure][l] = good ? p_high : pressure;
  }
}

}  // namespace adamas::datasets
