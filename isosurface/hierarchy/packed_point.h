#pragma once

#include <compare>
#include <cstdint>

#include "core/base/hash.h"
#include "core/lattice/lattice_map.h"
#include "core/lattice/lattice_point.h"

namespace adamas {

/// A lattice point as one word, 21 bits a coordinate, for tables of many points.
struct PackedPoint {
  static constexpr int kBits = 21;

  std::uint64_t word;

  constexpr bool operator==(const PackedPoint&) const = default;
};

/// Coordinates must be multiples of 2^shift, and below 2^PackedPoint::kBits once divided by it.
constexpr PackedPoint pack(LatticePoint p, int shift) {
  const auto part = [shift](std::int32_t x) { return static_cast<std::uint64_t>(x >> shift); };
  return {part(p.i) | part(p.j) << PackedPoint::kBits | part(p.k) << (2 * PackedPoint::kBits)};
}

constexpr LatticePoint unpack(PackedPoint p, int shift) {
  const auto part = [&](int axis) {
    constexpr std::uint64_t kMask = (std::uint64_t{1} << PackedPoint::kBits) - 1;
    return static_cast<std::int32_t>(p.word >> (axis * PackedPoint::kBits) & kMask) << shift;
  };
  return {part(0), part(1), part(2)};
}

/// A 64-bit hash; its high bits are good for points of every scale.
constexpr std::uint64_t hash_value(PackedPoint p) {
  return remix(fibonacci_hash(p.word));
}

template <>
inline constexpr PackedPoint kNoKey<PackedPoint>{~std::uint64_t{0}};

}  // namespace adamas
