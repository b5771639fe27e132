#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/lattice/diamond_type.h"

namespace adamas {

/// Where the samples of the small tetrahedra lie that bisection makes, and with which weights their corners
/// are interpolated there: worked out once, since there are but few kinds and very many of each.
class TetrahedronStencils {
 public:
  /// Diamonds of scales up to 2^(kScales - 1) samples.
  static constexpr int kScales = 3;

  /// For blocks of `count` samples per axis, i running fastest.
  explicit TetrahedronStencils(const std::array<std::int32_t, 3>& count);

  /// Indices of the corners from that of the diamond's split vertex.
  [[nodiscard]] const std::array<std::ptrdiff_t, 4>& corners(int scale_bits, int type, int slot) const {
    return at(scale_bits, type, slot).corners;
  }

  /// The greatest difference between the samples in and on the tetrahedron, all of which are in the block,
  /// and the linear interpolation of these values at its corners. Non-finite samples do not count.
  template <class Sample>
  [[nodiscard]] double error(const Sample* split_vertex, int scale_bits, int type, int slot,
                             const std::array<double, 4>& values) const;

 private:
  struct Point {
    std::ptrdiff_t offset;
    std::array<double, 4> weights;
  };
  struct Stencil {
    std::array<std::ptrdiff_t, 4> corners{};
    std::uint32_t first = 0, last = 0;  ///< of points_
  };

  [[nodiscard]] const Stencil& at(int scale_bits, int type, int slot) const {
    return stencils_[static_cast<std::size_t>((scale_bits * kDiamondTypeCount + type) * 8 + slot)];
  }
  [[nodiscard]] Stencil make(int scale_bits, const DiamondType& type, int slot);

  std::array<std::ptrdiff_t, 3> strides_;
  std::vector<Stencil> stencils_;
  std::vector<Point> points_;  ///< but for the corners
};

template <class Sample>
double TetrahedronStencils::error(const Sample* split_vertex, int scale_bits, int type, int slot,
                                  const std::array<double, 4>& values) const {
  const Stencil& stencil = at(scale_bits, type, slot);
  double greatest = 0;
  for (std::uint32_t n = stencil.first; n < stencil.last; ++n) {
    const auto& [offset, w] = points_[n];
    const double sample = split_vertex[offset];
    const double linear = w[0] * values[0] + w[1] * values[1] + w[2] * values[2] + w[3] * values[3];
    const double difference = std::abs(linear - sample);
    if constexpr (std::is_floating_point_v<Sample>) {
      if (!std::isfinite(sample)) continue;
    }
    greatest = std::max(greatest, difference);
  }
  return greatest;
}

}  // namespace adamas
