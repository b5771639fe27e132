#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/lattice/diamond.h"
#include "core/lattice/domain.h"
#include "isosurface/extraction/diamond_halves.h"

namespace adamas {

/// The values at the vertices of a diamond's tetrahedra in a domain.
struct DiamondVertices {
  unsigned slots = 0;  ///< of the tetrahedra in the domain, as bits
  double begin = 0, end = 0, middle = 0;
  std::array<double, 9> ring{};  ///< the first again behind the last

  /// `values(p)`: at the lattice point p. Without the middle its value is 0.
  template <class Values>
  DiamondVertices(const Diamond& diamond, const Domain& domain, bool with_middle, const Values& values);

  [[nodiscard]] std::array<double, 4> tetrahedron(int slot) const {
    const auto s = static_cast<std::size_t>(slot);
    return {begin, end, ring[s], ring[s + 1]};
  }
  /// Values of one half of a tetrahedron: see TetrahedronHalf::vertices.
  [[nodiscard]] std::array<double, 4> half(int slot, const std::array<std::uint8_t, 4>& vertices) const {
    const std::array<double, 4> whole = tetrahedron(slot);
    std::array<double, 4> result;
    for (std::size_t v = 0; v < 4; ++v) result[v] = vertices[v] < 4 ? whole[vertices[v]] : middle;
    return result;
  }
};

template <class Values>
DiamondVertices::DiamondVertices(const Diamond& diamond, const Domain& domain, bool with_middle,
                                 const Values& values) {
  const int count = diamond.tetrahedron_count();
  if (domain.boundary_count(diamond.point()) == 0) {
    slots = (1u << count) - 1;
  } else {
    for (const int slot : diamond.tetrahedra(domain)) slots |= 1u << slot;
  }
  const auto [a, b] = diamond.split_edge();
  begin = values(a);
  end = values(b);
  if (with_middle) middle = values(diamond.point());
  // Tetrahedron `slot` has the vertices `slot` and `slot` + 1 of the ring.
  const unsigned used = slots | slots << 1 | slots >> (count - 1);
  for (int r = 0; r < count; ++r) {
    if ((used >> r & 1) != 0) ring[static_cast<std::size_t>(r)] = values(diamond.ring(r));
  }
  ring[static_cast<std::size_t>(count)] = ring[0];
}

}  // namespace adamas
