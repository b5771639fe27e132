#pragma once

#include <algorithm>

#include "datasets/flow/mixture.h"

namespace adamas::datasets {

/// Opens and closes empty space, which is a material: metals do not hold together under tension but leave
/// void, and void closes before pressure builds up.
struct VoidOpening {
  std::size_t material = 0;  ///< the number of the material that stands for empty space, an ideal gas
  double pressure = 0;       ///< least pressure of a cell; above 0
  double density = 0;        ///< thinner void is compressed by any greater pressure
};

/// Changes the share of void in one cell so that the pressure is the one that VoidOpening asks for; masses,
/// momentum and total energy keep every bit. Leaves the cell as it is if it contains only void or too little
/// energy.
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
  // If the shares of all other materials are multiplied by x, the pressure is the wanted one when x times
  // `each` equals `left`.
  const double each = offset + opening.pressure * (inverse - filled * law.inverse[v]);
  const double left = internal - opening.pressure * law.inverse[v];
  if (!(filled > 0) || !(each > 0) || !(left > 0)) return;
  double x = left / each;
  // Void shrinks only until it is dense enough to have a pressure of its own.
  const double most = (1 - q[V::kMass + v][l] / opening.density) / filled;
  if (x > 1) x = std::max(1.0, std::min(x, most));
  for (std::size_t k = 0; k < N; ++k) q[V::kFraction + k][l] *= x;
  q[V::kFraction + v][l] = std::max(0.0, 1 - filled * x);
}

}  // namespace adamas::datasets
