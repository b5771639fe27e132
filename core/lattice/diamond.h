#pragma once

#include <array>
#include <cstddef>

#include "core/base/assert.h"
#include "core/lattice/diamond_type.h"
#include "core/lattice/lattice_point.h"

namespace adamas::inline core {

class Domain;

/// A list of at most N values, which lie in the object itself.
template <class T, std::size_t N>
class SmallList {
 public:
  constexpr void push_back(const T& value) {
    ADAMAS_ASSERT(size_ < N);
    values_[size_++] = value;
  }
  [[nodiscard]] constexpr std::size_t size() const { return size_; }
  [[nodiscard]] constexpr bool empty() const { return size_ == 0; }
  [[nodiscard]] constexpr const T* begin() const { return values_.data(); }
  [[nodiscard]] constexpr const T* end() const { return values_.data() + size_; }
  constexpr const T& operator[](std::size_t i) const { return values_[i]; }

 private:
  std::array<T, N> values_{};
  std::size_t size_ = 0;
};

/// The tetrahedra round one split edge. A diamond is its split vertex p, and everything else follows from the
/// bits of p (D 2): with t trailing zero bits, s = 2^t and q = p >> t, the phase is 3 minus the
/// number of odd coordinates of q. Coordinates may lie outside a domain where the diamond reaches over its
/// boundary; members that take a Domain leave out what does.
class Diamond {
 public:
  /// `point` must not be the corner of a root cube.
  constexpr explicit Diamond(LatticePoint point) : point_(point), bits_(trailing_zeros(point)) {
    ADAMAS_ASSERT(bits_ < kRootBits);
    type_ = diamond_type(point, bits_);
  }

  [[nodiscard]] constexpr LatticePoint point() const { return point_; }
  /// t, the number of trailing zero bits.
  [[nodiscard]] constexpr int scale_bits() const { return bits_; }
  /// s: half the side of the diamond's cube, in lattice units.
  [[nodiscard]] constexpr std::int32_t scale() const { return std::int32_t{1} << bits_; }
  [[nodiscard]] constexpr int level() const { return kRootBits - 1 - bits_; }
  /// Index into kDiamondTypes.
  [[nodiscard]] constexpr int type_index() const { return type_; }
  [[nodiscard]] const DiamondType& type() const { return kDiamondTypes[static_cast<std::size_t>(type_)]; }
  [[nodiscard]] int phase() const { return type().phase; }

  /// The ends of the split edge: p - s d and p + s d.
  [[nodiscard]] std::array<LatticePoint, 2> split_edge() const {
    const LatticePoint half = scale() * type().direction;
    return {point_ - half, point_ + half};
  }

  [[nodiscard]] int tetrahedron_count() const { return type().tetrahedron_count; }
  /// The vertices of tetrahedron `slot`, positively oriented, the split edge first.
  [[nodiscard]] std::array<LatticePoint, 4> tetrahedron(int slot) const {
    const auto [a, b] = split_edge();
    return {a, b, ring(slot), ring(slot + 1 == tetrahedron_count() ? 0 : slot + 1)};
  }
  /// Vertex between the tetrahedra `slot - 1` and `slot`.
  [[nodiscard]] LatticePoint ring(int slot) const {
    return point_ + scale() * type().ring[static_cast<std::size_t>(slot)];
  }

  [[nodiscard]] int child_count() const { return type().child_count; }
  /// The split vertex of child `c`. It needs scale_bits() > 0 in phase 2, where the lattice ends.
  [[nodiscard]] LatticePoint child(int c) const {
    const LatticePoint offset = type().child_offsets[static_cast<std::size_t>(c)];
    ADAMAS_ASSERT(bits_ > 0 || phase() < 2);
    return point_ + LatticePoint{offset.i * scale() / 2, offset.j * scale() / 2, offset.k * scale() / 2};
  }
  /// The number of parents: 0 for the diamonds of the root cubes, otherwise that of the type.
  [[nodiscard]] int parent_count() const { return level() == 0 && phase() == 0 ? 0 : type().parent_count; }
  [[nodiscard]] LatticePoint parent(int c) const {
    return point_ + scale() * type().parent_offsets[static_cast<std::size_t>(c)];
  }

  /// Slots of the tetrahedra in the domain.
  [[nodiscard]] SmallList<int, 8> tetrahedra(const Domain& domain) const;
  [[nodiscard]] int tetrahedron_count(const Domain& domain) const;
  /// The child diamonds in the domain; none at the end of the lattice.
  [[nodiscard]] SmallList<LatticePoint, 8> children(const Domain& domain) const;
  [[nodiscard]] SmallList<LatticePoint, 4> parents(const Domain& domain) const;

 private:
  LatticePoint point_;
  int bits_;
  int type_ = 0;
};

}  // namespace adamas::inline core
