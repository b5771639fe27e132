#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/hash.h"
#include "core/lattice/diamond.h"
#include "core/lattice/domain.h"
#include "core/lattice/lattice_map.h"
#include "core/lattice/lattice_point.h"

namespace adamas::test {

/// A lattice point as one word, 21 bits a coordinate, for tables of many points.
struct PackedPoint {
  static constexpr int kBits = 21;

  std::uint64_t word;

  constexpr bool operator==(const PackedPoint&) const = default;
};

/// Packs a point whose coordinates are multiples of 2^shift, and below 2^PackedPoint::kBits after division by
/// it.
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

/// Returns a 64-bit hash; its high bits are good for points of every scale.
constexpr std::uint64_t hash_value(PackedPoint p) { return remix(fibonacci_hash(p.word)); }

}  // namespace adamas::test

template <>
inline constexpr adamas::test::PackedPoint adamas::kNoKey<adamas::test::PackedPoint>{~std::uint64_t{0}};

namespace adamas::test {

/// The indexed hierarchy (D 2): a conforming mesh of tetrahedra that is kept as a table of diamonds alone,
/// without links. The table has the diamonds that are split or have a tetrahedron in the mesh; everything
/// else follows from the bits of their points. The same requests lead to the same mesh as in the
/// pointer-based hierarchy of interfaces/. The program does without such a table, since stores state which
/// diamonds are split; tests compare its meshes with this one.
class IndexedHierarchy {
 public:
  static constexpr int kMaxLevels = PackedPoint::kBits - 2;

  /// Throws Error where the numbers of roots and levels need more than kMaxLevels bits a coordinate.
  IndexedHierarchy(const Domain& domain, int levels);

  [[nodiscard]] const Domain& domain() const { return domain_; }
  /// Returns the number of levels; diamonds of lower levels can be split.
  [[nodiscard]] int levels() const { return levels_; }
  [[nodiscard]] bool can_split(LatticePoint p) const { return trailing_zeros(p) >= kRootBits - levels_; }

  [[nodiscard]] bool is_split(LatticePoint p) const {
    const State* state = diamonds_.find(key(p));
    return state != nullptr && state->split;
  }
  /// Returns whether the diamond is split and none of its children is.
  [[nodiscard]] bool can_merge(LatticePoint p) const {
    const State* state = diamonds_.find(key(p));
    return state != nullptr && state->split && state->split_children == 0;
  }
  /// Returns the slots of the diamond's tetrahedra that are in the mesh, as bits.
  [[nodiscard]] std::uint8_t tetrahedra(LatticePoint p) const {
    const State* state = diamonds_.find(key(p));
    return state != nullptr ? state->tetrahedra : std::uint8_t{0};
  }

  /// Splits the diamond, its ancestors that are not split first, and appends the points of all that were
  /// split, parents first. Does nothing for a diamond that is split or that can_split() refuses.
  void split(LatticePoint p, std::vector<LatticePoint>& done);
  /// Merges a diamond; does nothing where can_merge() is false. Returns whether it was merged.
  bool merge(LatticePoint p);

  /// Returns the number of tetrahedra in the mesh.
  [[nodiscard]] std::size_t tetrahedron_count() const { return tetrahedron_count_; }
  /// Returns the number of diamonds that are split or have a tetrahedron in the mesh.
  [[nodiscard]] std::size_t diamond_count() const { return diamonds_.size(); }
  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const { return diamonds_.bytes(); }

  /// Calls fn(diamond, slots) for the diamonds with tetrahedra in the mesh, their slots as bits, in an order
  /// that depends on history.
  template <class Fn>
  void for_each_diamond(Fn&& fn) const;
  /// Calls fn(diamond, slot) for the tetrahedra of the mesh, in an order that depends on history.
  template <class Fn>
  void for_each_tetrahedron(Fn&& fn) const;

  /// Throws std::logic_error that names the first broken law.
  void validate() const;
  /// Returns a checksum of the mesh alone, which equals that of a pointer-based hierarchy with the same mesh.
  [[nodiscard]] std::uint64_t checksum() const;

 private:
  struct State {
    std::uint8_t tetrahedra = 0;  ///< bits, by slot
    std::uint8_t split_children = 0;
    bool split = false;
  };

  [[nodiscard]] PackedPoint key(LatticePoint p) const { return pack(p, shift_); }
  void prefetch(LatticePoint p) const;
  void split_complete(LatticePoint p);
  void validate_diamond(LatticePoint p, const State& state) const;

  Domain domain_;
  int levels_, shift_;
  LatticeMap<State, PackedPoint, true> diamonds_;
  std::size_t tetrahedron_count_ = 0;
};

template <class Fn>
void IndexedHierarchy::for_each_diamond(Fn&& fn) const {
  diamonds_.for_each([&](PackedPoint packed, const State& state) {
    if (state.tetrahedra != 0) fn(Diamond(unpack(packed, shift_)), state.tetrahedra);
  });
}

template <class Fn>
void IndexedHierarchy::for_each_tetrahedron(Fn&& fn) const {
  for_each_diamond([&](const Diamond& diamond, std::uint8_t slots) {
    for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
      if ((slots >> slot & 1) != 0) fn(diamond, slot);
    }
  });
}

}  // namespace adamas::test
