#pragma once

#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "core/base/hash.h"

namespace adamas::inline core {

/// The side of a root cube is 2^kRootBits lattice units.
inline constexpr int kRootBits = 24;

/// A point of the integer lattice that spans a domain, or the difference of two such points.
struct LatticePoint {
  std::int32_t i, j, k;

  constexpr std::int32_t& operator[](int axis) { return axis == 0 ? i : axis == 1 ? j : k; }
  constexpr std::int32_t operator[](int axis) const { return axis == 0 ? i : axis == 1 ? j : k; }
  constexpr auto operator<=>(const LatticePoint&) const = default;
};

constexpr LatticePoint operator+(LatticePoint a, LatticePoint b) { return {a.i + b.i, a.j + b.j, a.k + b.k}; }
constexpr LatticePoint operator-(LatticePoint a, LatticePoint b) { return {a.i - b.i, a.j - b.j, a.k - b.k}; }
constexpr LatticePoint operator-(LatticePoint a) { return {-a.i, -a.j, -a.k}; }
constexpr LatticePoint operator*(std::int32_t s, LatticePoint a) { return {s * a.i, s * a.j, s * a.k}; }

/// The nth of the 27 steps from -1 to 1 along each axis, i running fastest.
constexpr LatticePoint step_around(int n) { return {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1}; }
/// Whether all coordinates are from 0 to below those of `end`.
constexpr bool is_below(LatticePoint p, LatticePoint end) {
  return p.i >= 0 && p.j >= 0 && p.k >= 0 && p.i < end.i && p.j < end.j && p.k < end.k;
}

/// The least number of trailing zero bits of the three coordinates; 32 for the origin.
constexpr int trailing_zeros(LatticePoint p) {
  return std::countr_zero(static_cast<std::uint32_t>(p.i | p.j | p.k));
}

/// A 64-bit hash; its high bits are good for points of every scale.
constexpr std::uint64_t hash_value(LatticePoint p) {
  // The factors of j and k are two of the primes of xxHash.
  std::uint64_t h = fibonacci_hash(static_cast<std::uint32_t>(p.i));
  h += static_cast<std::uint32_t>(p.j) * 0xc2b2ae3d27d4eb4full;
  h += static_cast<std::uint32_t>(p.k) * 0x165667b19e3779f9ull;
  return remix(h);
}

}  // namespace adamas::inline core

template <>
struct std::hash<adamas::LatticePoint> {
  std::size_t operator()(adamas::LatticePoint p) const noexcept {
    const std::uint64_t h = adamas::hash_value(p);
    return h ^ (h >> 29);
  }
};
