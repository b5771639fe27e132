#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/data/multi_material_data.h"

namespace adamas::test {

/// Two materials on either side of a plane, dot(normal, x) = offset, the first where it is less.
struct HalfSpace {
  MultiMaterialData data;
  double offset = 0;
};

/// Returns which part of the unit box has m[0] x + m[1] y + m[2] z <= alpha, by inclusion and exclusion of
/// the box's corners.
inline double part_of_box(const std::array<double, 3>& m, double alpha) {
  double sum = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    double rest = alpha, sign = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1u) != 0) rest -= m[axis], sign = -sign;
    }
    if (rest > 0) sum += sign * rest * rest * rest;
  }
  return std::clamp(sum / (6 * m[0] * m[1] * m[2]), 0.0, 1.0);
}

/// Returns the fractions on a grid of n cells per axis, whose steps grow where it is stretched. No component
/// of the normal may be zero.
inline HalfSpace half_space_fractions(const Vec3& normal, int n, bool stretched) {
  HalfSpace result;
  MultiMaterialData& data = result.data;
  data.source = "half space";
  for (auto& x : data.grid.nodes) {
    for (int i = 0; i <= n; ++i) x.push_back((stretched ? i + 0.03 * i * i : i) / static_cast<double>(n));
  }
  data.materials.push_back("below");
  data.materials.push_back("above");
  data.fractions.resize(2);
  const Box3 domain = data.grid.domain();
  result.offset =
      dot(normal, domain.min + Vec3{0.52 * domain.size().x, 0.49 * domain.size().y, 0.51 * domain.size().z});
  const auto& [x, y, z] = data.grid.nodes;
  for (std::size_t k = 0; k + 1 < z.size(); ++k) {
    for (std::size_t j = 0; j + 1 < y.size(); ++j) {
      for (std::size_t i = 0; i + 1 < x.size(); ++i) {
        const Box3 cell{{x[i], y[j], z[k]}, {x[i + 1], y[j + 1], z[k + 1]}};
        std::array<double, 3> m{};
        double alpha = result.offset;
        for (int axis = 0; axis < 3; ++axis) {
          m[static_cast<std::size_t>(axis)] = std::abs(normal[axis]) * cell.size()[axis];
          alpha -= normal[axis] * (normal[axis] > 0 ? cell.min : cell.max)[axis];
        }
        const double below = part_of_box(m, alpha);
        data.fractions[MaterialId(0)].push_back(static_cast<float>(below));
        data.fractions[MaterialId(1)].push_back(static_cast<float>(1 - below));
      }
    }
  }
  data.normalise();
  return result;
}

}  // namespace adamas::test
