#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "adamas/geometry.h"
#include "core/lattice/lattice_point.h"
#include "isosurface/contour/contour.h"

namespace adamas::isosurface {

/// The two ends of an edge of the mesh that a surface crosses, in 24 bytes.
struct EdgeEnds {
  /// The coordinates of both points, from 0 to 17 steps of the page from the chunk's corner, in five bits
  /// each; i of the first point has the lowest bits.
  std::uint32_t points = 0;
  std::array<float, 2> values{};  ///< the samples at the points
  /// The negative gradients at both points, scaled so that the greatest component of both is kUnits. Zero
  /// where there is no normal.
  std::array<std::int16_t, 6> descents{};

  static constexpr int kBits = 5;
  static constexpr double kUnits = 32767;

  EdgeEnds() = default;
  bool operator==(const EdgeEnds&) const = default;
  EdgeEnds(const std::array<LatticePoint, 2>& at, const std::array<float, 2>& samples,
           const std::array<Vec3, 2>& gradients)
      : values(samples) {
    int shift = 0;
    for (const LatticePoint& p : at) {
      for (int axis = 0; axis < 3; ++axis, shift += kBits)
        points |= static_cast<std::uint32_t>(p[axis]) << shift;
    }
    double most = 0;
    for (const Vec3& g : gradients) most = std::max({most, std::abs(g.x), std::abs(g.y), std::abs(g.z)});
    if (!(most > 0) || !std::isfinite(most)) return;
    for (std::size_t n = 0; n < 6; ++n) {
      const double part = -kUnits / most * gradients[n / 3][static_cast<int>(n % 3)];
      descents[n] = static_cast<std::int16_t>(part + std::copysign(0.5, part));
    }
  }

  /// Returns the points, in steps from the chunk's corner.
  [[nodiscard]] std::array<LatticePoint, 2> places() const {
    std::array<LatticePoint, 2> at;
    int shift = 0;
    for (LatticePoint& p : at) {
      for (int axis = 0; axis < 3; ++axis, shift += kBits)
        p[axis] = static_cast<std::int32_t>(points >> shift & 31u);
    }
    return at;
  }
  /// Returns a point of the edge, in steps from the chunk's corner.
  [[nodiscard]] Vec3 at(double parameter) const {
    const auto [first, second] = places();
    const auto along = [&, a = first, b = second](int axis) {
      return (1 - parameter) * a[axis] + parameter * b[axis];
    };
    return {along(0), along(1), along(2)};
  }
  /// Returns the parameter at which the surface crosses the edge: 0 at the first point, 1 at the second. See
  /// ContourOptions.
  [[nodiscard]] double parameter(double isovalue, double least_parameter) const {
    return std::clamp(edge_parameter(values[0], values[1], isovalue), least_parameter, 1 - least_parameter);
  }
};

}  // namespace adamas::isosurface
