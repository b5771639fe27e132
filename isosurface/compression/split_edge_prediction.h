#pragma once

#include <array>
#include <cstdint>

#include "core/lattice/diamond_type.h"
#include "core/lattice/lattice_point.h"

namespace adamas {

/// The samples from whose mean that at p is predicted (D 4.11): the ends of the split edge of its diamond. A
/// coordinate beyond the data is mirrored at p, where there always is a sample, and a coarser one: an LOD
/// depends on coarser LODs only. Coordinates count samples; p has one that is not 0, and `dimensions` are
/// those of the data.
constexpr std::array<LatticePoint, 2> predictors(LatticePoint p,
                                                 const std::array<std::int32_t, 3>& dimensions) {
  const int bits = trailing_zeros(p);
  const LatticePoint d = split_direction({p.i >> bits, p.j >> bits, p.k >> bits});
  std::array<LatticePoint, 2> ends{};
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t half = d[axis] * (std::int32_t{1} << bits);
    const bool both = p[axis] + (half < 0 ? -half : half) < dimensions[static_cast<std::size_t>(axis)];
    const std::int32_t below = half < 0 ? half : -half;
    ends[0][axis] = p[axis] + (both ? -half : below);
    ends[1][axis] = p[axis] + (both ? half : below);
  }
  return ends;
}

/// The prediction, of samples as `ordered` gives them.
constexpr std::uint32_t predicted(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint32_t>((std::uint64_t{a} + b) / 2);
}

}  // namespace adamas
