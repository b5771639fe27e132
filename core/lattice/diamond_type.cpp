#include "core/lattice/diamond_type.h"

#include <utility>

namespace adamas::inline core {
namespace {

using ChildTetrahedron = DiamondType::ChildTetrahedron;
using Corners = std::array<LatticePoint, 5>;

constexpr std::size_t index(int i) { return static_cast<std::size_t>(i); }

constexpr int dot(LatticePoint a, LatticePoint b) { return a.i * b.i + a.j * b.j + a.k * b.k; }

constexpr int determinant(LatticePoint a, LatticePoint b, LatticePoint c) {
  return a.i * (b.j * c.k - b.k * c.j) + a.j * (b.k * c.i - b.i * c.k) + a.k * (b.i * c.j - b.j * c.i);
}

/// Whether diamonds with direction d have a vertex at this offset beside the split edge: the other corners of
/// the cube in phase 0; the other corners of the face and the centres of its two cubes in phase 1; the
/// centres of the faces and cubes round the edge in phase 2.
constexpr bool in_ring(const DiamondType& type, LatticePoint o) {
  if (type.phase == 0) return dot(o, o) == 3 && o != type.direction && o != -type.direction;
  return o != LatticePoint{} && dot(o, type.direction) == 0 && dot(o, o) <= 2;
}

constexpr bool is_next_in_ring(const DiamondType& type, LatticePoint r, LatticePoint next) {
  if (determinant(type.direction, r, next) <= 0) return false;
  for (int x = 0; x < type.tetrahedron_count; ++x) {
    const LatticePoint o = type.ring[index(x)];
    if (determinant(type.direction, r, o) > 0 && determinant(type.direction, o, next) > 0) return false;
  }
  return true;
}

constexpr DiamondType make_ring(LatticePoint direction) {
  DiamondType type{};
  type.direction = direction;
  type.phase = 3 - dot(direction, direction);
  for (int code = 0; code < 27; ++code) {
    const LatticePoint o{code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1};
    if (in_ring(type, o)) type.ring[index(type.tetrahedron_count++)] = o;
  }
  DiamondType sorted = type;
  for (int i = 1; i < type.tetrahedron_count; ++i) {
    int x = 0;
    while (!is_next_in_ring(type, sorted.ring[index(i - 1)], type.ring[index(x)])) ++x;
    sorted.ring[index(i)] = type.ring[index(x)];
  }
  return sorted;
}

/// Offsets of a tetrahedron's four vertices and of the split vertex, in units of s / 2.
constexpr Corners corners(const DiamondType& type, int slot) {
  const LatticePoint r0 = type.ring[index(slot)];
  const LatticePoint r1 = type.ring[index((slot + 1) % type.tetrahedron_count)];
  return {-2 * type.direction, 2 * type.direction, 2 * r0, 2 * r1, LatticePoint{}};
}

/// Midpoint of the longest edge of the half of a tetrahedron that keeps the given end.
constexpr LatticePoint longest_edge_midpoint(const Corners& c, int end) {
  int longest = 0;
  LatticePoint sum{};
  for (int a = 0; a < 5; ++a) {
    for (int b = 0; b < a; ++b) {
      if (a == 1 - end || b == 1 - end) continue;
      const LatticePoint edge = c[index(a)] - c[index(b)];
      if (dot(edge, edge) <= longest) continue;
      longest = dot(edge, edge);
      sum = c[index(a)] + c[index(b)];
    }
  }
  return {sum.i / 2, sum.j / 2, sum.k / 2};
}

/// Finds the half of a tetrahedron among the tetrahedra of a child diamond at `offset`.
constexpr ChildTetrahedron place(const Corners& c, int slot, int end, const DiamondType& child,
                                 LatticePoint offset) {
  const int scale = child.phase == 0 ? 1 : 2;
  for (int child_slot = 0; child_slot < child.tetrahedron_count; ++child_slot) {
    const Corners wanted = corners(child, child_slot);
    ChildTetrahedron result{static_cast<std::uint8_t>(slot),
                            static_cast<std::uint8_t>(end),
                            static_cast<std::uint8_t>(child_slot),
                            {}};
    int found = 0;
    for (int w = 0; w < 4; ++w) {
      const LatticePoint half = wanted[index(w)];
      const LatticePoint target =
          offset + LatticePoint{half.i * scale / 2, half.j * scale / 2, half.k * scale / 2};
      for (int a = 0; a < 5; ++a) {
        if (a == 1 - end || c[index(a)] != target) continue;
        result.vertices[index(w)] = static_cast<std::uint8_t>(a);
        ++found;
      }
    }
    if (found == 4) return result;
  }
  throw "the half of a tetrahedron is none of its child diamond's tetrahedra";
}

constexpr int child_at(DiamondType& type, LatticePoint offset) {
  for (int child = 0; child < type.child_count; ++child) {
    if (type.child_offsets[index(child)] == offset) return child;
  }
  type.child_offsets[index(type.child_count)] = offset;
  return type.child_count++;
}

constexpr DiamondType make_type(std::size_t type_index) {
  constexpr std::array<LatticePoint, kDiamondTypeCount> kDirections = diamond_directions();
  DiamondType type = make_ring(kDirections[type_index]);
  std::array<DiamondType, 8> child_rings{};
  std::array<std::size_t, 8> placed{};
  for (int slot = 0; slot < type.tetrahedron_count; ++slot) {
    for (int end = 0; end < 2; ++end) {
      const Corners c = corners(type, slot);
      const LatticePoint offset = longest_edge_midpoint(c, end);
      const std::size_t child = index(child_at(type, offset));
      if (placed[child] == 0) {
        // The offset is seen from the point 2 d of a lattice of step s / 2, whose diamond has this type.
        const LatticePoint point = 2 * type.direction + offset;
        type.child_types[child] = static_cast<std::uint8_t>(diamond_type(point, trailing_zeros(point)));
        child_rings[child] = make_ring(kDirections[type.child_types[child]]);
      }
      type.child_tetrahedra[child][placed[child]++] = place(c, slot, end, child_rings[child], offset);
    }
  }
  return type;
}

constexpr void add_parent(DiamondType& type, LatticePoint offset) {
  for (int i = 0; i < type.parent_count; ++i) {
    if (type.parent_offsets[index(i)] == offset) return;
  }
  type.parent_offsets[index(type.parent_count++)] = offset;
}

/// Each type has a variable of its own, which keeps each evaluation within the limits of the compilers.
template <std::size_t Index>
constexpr DiamondType kType = make_type(Index);

template <std::size_t... Indices>
constexpr std::array<DiamondType, kDiamondTypeCount> make_types(std::index_sequence<Indices...>) {
  std::array<DiamondType, kDiamondTypeCount> types{kType<Indices>...};
  for (const DiamondType& parent : {kType<Indices>...}) {
    for (int c = 0; c < parent.child_count; ++c) {
      DiamondType& child = types[parent.child_types[index(c)]];
      const LatticePoint o = parent.child_offsets[index(c)];
      const int unit = child.phase == 0 ? 1 : 2;  // the child's scale in units of s / 2
      add_parent(child, {-o.i / unit, -o.j / unit, -o.k / unit});
    }
  }
  return types;
}

}  // namespace

constinit const std::array<DiamondType, kDiamondTypeCount> kDiamondTypes =
    make_types(std::make_index_sequence<kDiamondTypeCount>());

}  // namespace adamas::inline core
