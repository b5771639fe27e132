#pragma once

#include <cmath>
#include <cstddef>
#include <functional>

#include "core/base/parallel.h"
#include "core/data/multi_material_data.h"

namespace adamas::test {

/// The material on the other side of a sheet, where the distance is negative.
enum class OtherSide { kSameMaterial, kThirdMaterial };

/// Returns the fractions of a sheet, the second material, in the cells of the unit cube. The sheet is the set
/// of points whose distance from the zero set of a signed distance is below half of its thickness, which is
/// given in cells. Points are counted in the cells that it may cut.
inline MultiMaterialData sheet_fractions(std::size_t n, double thickness,
                                         const std::function<double(const Vec3&)>& distance,
                                         OtherSide other = OtherSide::kSameMaterial) {
  constexpr std::size_t kSide = 10, kSamples = kSide * kSide * kSide;
  MultiMaterialData data;
  data.source = "counted";
  data.grid.centering = Centering::kCells;
  const double h = 1.0 / static_cast<double>(n), half = 0.5 * thickness * h;
  for (auto& nodes : data.grid.nodes) {
    for (std::size_t i = 0; i <= n; ++i) nodes.push_back(h * static_cast<double>(i));
  }
  for (const char* name : {"a", "b", "c"}) {
    if (data.materials.size() == 2 && other == OtherSide::kSameMaterial) break;
    data.materials.emplace_back(name);
    data.fractions.emplace_back(n * n * n, 0.0f);
  }
  const auto material = [&](double d) {
    if (std::abs(d) < half) return MaterialId(1);
    return MaterialId(d < 0 && other == OtherSide::kThirdMaterial ? 2 : 0);
  };
  parallel_for(n * n * n, 64, [&](std::size_t site) {
    const Vec3 low{h * static_cast<double>(site % n), h * static_cast<double>(site / n % n),
                   h * static_cast<double>(site / (n * n))};
    // No point of the cell is farther from its middle than half its diagonal.
    const double middle = distance(low + Vec3{0.5 * h, 0.5 * h, 0.5 * h});
    if (std::abs(middle) > half + 0.87 * h) {
      data.fractions[material(middle)][site] = 1;
      return;
    }
    for (std::size_t s = 0; s < kSamples; ++s) {
      const auto at = [&](std::size_t k) { return h * (static_cast<double>(k) + 0.5) / kSide; };
      const Vec3 p = low + Vec3{at(s % kSide), at(s / kSide % kSide), at(s / (kSide * kSide))};
      data.fractions[material(distance(p))][site] += 1.0f / kSamples;
    }
  });
  data.normalise();
  return data;
}

}  // namespace adamas::test
