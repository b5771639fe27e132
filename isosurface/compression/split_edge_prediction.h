#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "core/lattice/diamond_type.h"
#include "core/lattice/lattice_point.h"

namespace adamas {

/// The samples from whose mean that at p is predicted (D 4.11): the ends of the split edge of its diamond. A
/// coordinate beyond the data is mirrored at p, where there always is a sample, and a coarser one: a level
/// depends on coarser levels only. Coordinates count samples; p has one that is not 0, and `dimensions` are
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

/// Samples as unsigned integers in the order of their values, every bit kept: NaN and -0 too.
constexpr std::uint32_t ordered(std::uint8_t sample) { return sample; }
constexpr std::uint32_t ordered(std::uint16_t sample) { return sample; }
constexpr std::uint32_t ordered(std::int16_t sample) { return static_cast<std::uint16_t>(sample) ^ 0x8000u; }
constexpr std::uint32_t ordered(float sample) {
  const auto word = std::bit_cast<std::uint32_t>(sample);
  return (word & 0x80000000u) != 0 ? ~word : word | 0x80000000u;
}

/// The inverse.
template <class Sample>
constexpr Sample from_ordered(std::uint32_t value) {
  if constexpr (std::is_same_v<Sample, float>) {
    return std::bit_cast<float>((value & 0x80000000u) != 0 ? value & 0x7fffffffu : ~value);
  } else if constexpr (std::is_same_v<Sample, std::int16_t>) {
    return static_cast<std::int16_t>(value ^ 0x8000u);
  } else {
    return static_cast<Sample>(value);
  }
}

}  // namespace adamas
