#pragma once

#include <algorithm>

#include "datasets/flow/mixture.h"

namespace adamas::datasets {

/// Opens and closes empty space, which is a material: metals do not hold together under tension but leave
/// void, and void closes before pressure builds up.
struct VoidOpening {
  std::size_t material = 0;  ///< the number of the material that stands for empty space, an ideal gas
  double pressure = 0;       ///< least pressure of a cell; above 0
  double density = 0;        ///< void that is thinner than this gives way to any greater pressure
};

/// Moves the share of void of one cell, all else kept, so that the pressure is what VoidOpening asks for:
/// masses, momentum and total energy stay to the last bit. Leaves the cell as it is where it holds nothing
/// but void, or too little energy.
template <std::size_t N>
void move_void(const MixtureLaw<N>& law, const VoidOpening& opening, Row<N>& q, std::size_t l) {
  using V = Variables<N>;
  const std::size_t v = opening.material;
  double density = 0, inverse = 0, offset = 0, filled = 0;
  for (std::size_t k = 0; k < N; ++k) {
    density += q[V::kMass + k][l];
    if (k == v) continue;
    filled += q[V::kFraction + k][l];
    inverse += q[V::kFraction + k][l] * law.inverse[k];
    offset += q[V::kFraction + k][l] * law.offset[k];
  }
  const double a = q[V::kNormal][l], b = q[V::kTransverse][l], c = q[V::kTransverse + 1][l];
  const double internal = q[V::kEnergy][l] - 0.5 * (a * a + (b * b + c * c)) / density;
  // With all others' shares times x, the pressure is that wanted where x times this is what is left.
  const double each = offset + opening.pressure * (inverse - filled * law.inverse[v]);
  const double left = internal - opening.pressure * law.inverse[v];
  if (!(filled > 0) || !(each > 0) || !(left > 0)) return;
  double x = left / each;
  // Void shrinks until it is dense enough to have a pressure of its own, and no further.
  const double most = (1 - q[V::kMass + v][l] / opening.density) / filled;
  if (x > 1) x = std::max(1.0, std::min(x, most));
  for (std::size_t k = 0; k < N; ++k) q[V::kFraction + k][l] *= x;
  q[V::kFraction + v][l] = std::max(0.0, 1 - filled * x);
}

}  // namespace adamas::datasets
