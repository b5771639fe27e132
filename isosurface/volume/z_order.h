#pragma once

#include <cstdint>

#include "core/base/assert.h"
#include "core/lattice/lattice_point.h"

namespace adamas::isosurface {

/// Hierarchical z-order (D A): a sequence of the lattice points of a cube, coarse lattices before finer ones,
/// and the points that a finer one adds in z-order. Neighbours in space are mostly neighbours in the
/// sequence, and the points of any LOD are a prefix of it.
class ZOrder {
 public:
  static constexpr int kMaxBits = 21;  ///< bits per coordinate, so that an index has 63 bits

  /// Makes the order of points whose coordinates are from 0 to 2^bits - 1; 1 <= bits <= kMaxBits.
  constexpr explicit ZOrder(int bits) : bits_(bits) { ADAMAS_ASSERT(bits > 0 && bits <= kMaxBits); }

  [[nodiscard]] constexpr int bits() const { return bits_; }
  /// Returns the number of points; indices are below it.
  [[nodiscard]] constexpr std::uint64_t size() const { return std::uint64_t{1} << (3 * bits_); }
  /// Returns the number of points whose coordinates are all multiples of 2^lod; they come first.
  [[nodiscard]] constexpr std::uint64_t size(int lod) const {
    return std::uint64_t{1} << (3 * (bits_ - lod));
  }

  /// Returns the plain z-order of a point: bit b of i, j and k becomes bit 3 b, 3 b + 1 and 3 b + 2.
  static constexpr std::uint64_t interleave(LatticePoint p) {
    return spread(p.i) | spread(p.j) << 1 | spread(p.k) << 2;
  }
  /// Returns the point of an index in plain z-order.
  static constexpr LatticePoint deinterleave(std::uint64_t z) {
    return {gather(z), gather(z >> 1), gather(z >> 2)};
  }

  [[nodiscard]] constexpr std::uint64_t index(LatticePoint p) const {
    const std::uint64_t z = interleave(p);
    if (z == 0) return 0;
    const int below = std::countr_zero(z) / 3;
    const std::uint64_t n = z >> (3 * below);
    return before(bits_ - below) + n - (n >> 3) - 1;
  }

  [[nodiscard]] constexpr LatticePoint point(std::uint64_t index) const {
    if (index == 0) return {0, 0, 0};
    const int top = (std::bit_width(index) + 2) / 3;
    const std::uint64_t rest = index - before(top);
    return deinterleave((rest + rest / 7 + 1) << (3 * (bits_ - top)));
  }

 private:
  /// Returns the number of points before those that the lattice with `top` bits per coordinate adds.
  static constexpr std::uint64_t before(int top) { return std::uint64_t{1} << (3 * (top - 1)); }

  /// Moves bit b of x to bit 3 b.
  static constexpr std::uint64_t spread(std::int32_t x) {
    std::uint64_t v = static_cast<std::uint32_t>(x);
    v = (v | v << 32) & 0x001f00000000ffffull;
    v = (v | v << 16) & 0x001f0000ff0000ffull;
    v = (v | v << 8) & 0x100f00f00f00f00full;
    v = (v | v << 4) & 0x10c30c30c30c30c3ull;
    return (v | v << 2) & 0x1249249249249249ull;
  }
  /// Moves bit 3 b to bit b; other bits are ignored.
  static constexpr std::int32_t gather(std::uint64_t v) {
    v &= 0x1249249249249249ull;
    v = (v | v >> 2) & 0x10c30c30c30c30c3ull;
    v = (v | v >> 4) & 0x100f00f00f00f00full;
    v = (v | v >> 8) & 0x001f0000ff0000ffull;
    v = (v | v >> 16) & 0x001f00000000ffffull;
    v = (v | v >> 32) & 0x00000000001fffffull;
    return static_cast<std::int32_t>(v);
  }

  int bits_;
};

}  // namespace adamas::isosurface
