#pragma once

#include <algorithm>
#include <cmath>

#include "datasets/flow/mixture.h"
#include "datasets/flow/vectorisation.h"

namespace adamas::datasets {

/// The fluxes through the faces of kLanes pairs of cells: for each conserved variable, and the velocity of
/// the material on the face.
template <std::size_t N>
struct FaceFlux {
  Row<N> flow;
  std::array<double, kLanes> velocity;
};

/// One side of a Riemann problem in one lane.
struct RiemannSide {
  MixtureMeans mean;
  double velocity = 0, pressure = 0, energy = 0, sound = 0;
};

template <std::size_t N>
[[gnu::always_inline]] inline RiemannSide riemann_side(const MixtureLaw<N>& law, const Row<N>& w,
                                                       std::size_t l) {
  using V = Variables<N>;
  RiemannSide side;
  for_each_material<N>([&](std::size_t k) {
    const double fraction = w[V::kFraction + k][l];
    side.mean.density += fraction * w[V::kDensity + k][l];
    side.mean.inverse += fraction * law.inverse[k];
    side.mean.offset += fraction * law.offset[k];
  });
  side.velocity = w[V::kNormal][l];
  side.pressure = w[V::kPressure][l];
  const double b = w[V::kTransverse][l], c = w[V::kTransverse + 1][l];
  side.energy = side.mean.inverse * side.pressure + side.mean.offset +
                0.5 * side.mean.density * (side.velocity * side.velocity + (b * b + c * c));
  side.sound = std::sqrt(side.mean.stiffness_at(side.pressure) / side.mean.density);
  return side;
}

/// Solves the Riemann problem approximately with two waves and a contact (Toro, Spruce and Speares 1994),
/// with the speeds of Davis (1988). Everything that is advected, also fractions, has the same velocity on the
/// face as the mass, so that a contact in equilibrium stays so (Johnsen and Colonius 2006).
template <std::size_t N>
ADAMAS_VECTOR_CLONES void hllc(const MixtureLaw<N>& law, const Row<N>& left, const Row<N>& right,
                               FaceFlux<N>& face) {
  using V = Variables<N>;
  ADAMAS_INDEPENDENT_LANES
  for (std::size_t l = 0; l < kLanes; ++l) {
    const RiemannSide a = riemann_side(law, left, l), b = riemann_side(law, right, l);
    const double slowest = std::min(a.velocity - a.sound, b.velocity - b.sound);
    const double fastest = std::max(a.velocity + a.sound, b.velocity + b.sound);
    const double flow_a = a.mean.density * (slowest - a.velocity);
    const double flow_b = b.mean.density * (fastest - b.velocity);
    const double contact =
        (b.pressure - a.pressure + (flow_a * a.velocity - flow_b * b.velocity)) / (flow_a - flow_b);
    // These are the values of the side that the face lies on; behind its wave, if that has not passed the
    // face, the state is another one.
    const bool from_left = contact >= 0;
    const auto pick = [&](std::size_t v) {
      const double on_left = left[v][l], on_right = right[v][l];
      return from_left ? on_left : on_right;
    };
    const double density = from_left ? a.mean.density : b.mean.density;
    const double velocity = from_left ? a.velocity : b.velocity;
    const double pressure = from_left ? a.pressure : b.pressure;
    const double energy = from_left ? a.energy : b.energy;
    const double wave = from_left ? slowest : fastest;
    // This selects numbers, not conditions, so that the loop becomes vector instructions.
    const bool behind = (from_left ? slowest : -fastest) < 0;
    const double lead = wave - velocity;
    const double squeeze = lead / (wave - contact);
    const double star_pressure = pressure + density * lead * (contact - velocity);
    const double star_energy =
        squeeze * (energy + (contact - velocity) * (density * contact + pressure / lead));
    const double at = behind ? contact : velocity;
    const double push = behind ? star_pressure : pressure;
    const double carried = behind ? squeeze * contact : velocity;
    face.velocity[l] = carried;
    for_each_material<N>([&](std::size_t k) {
      const double fraction = pick(V::kFraction + k);
      face.flow[V::kFraction + k][l] = fraction * carried;
      face.flow[V::kMass + k][l] = fraction * pick(V::kDensity + k) * carried;
    });
    face.flow[V::kNormal][l] = density * carried * at + push;
    for (const std::size_t v : {V::kTransverse, V::kTransverse + 1}) {
      face.flow[v][l] = density * carried * pick(v);
    }
    face.flow[V::kEnergy][l] = ((behind ? star_energy : energy) + push) * at;
  }
}

}  // namespace adamas::datasets
