#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "interfaces/reconstruction/cut_volumes.h"

namespace adamas::interfaces {

/// A material, by a number, with values at the corners of a tetrahedron.
struct CornerValues {
  std::uint16_t number;
  std::array<double, 4> values;
};

/// Divides tetrahedra among materials: a point belongs to that with the greatest value there.
class TetrahedronShares {
 public:
  /// Calls add(number, part) for the parts of the tetrahedron that materials own, and, with `growth`,
  /// exchange(a, b, growth) for every two of them: the derivatives, with respect to the corners' values of
  /// the first one less those of the second one, of what the first one gets from the second one.
  template <class Add, class Exchange>
  void divide(const std::vector<CornerValues>& materials, bool growth, Add&& add, Exchange&& exchange) {
    const std::size_t count = materials.size();
    if (count == 2) {
      const PositivePart found = positive_part(difference(materials[0], materials[1]));
      add(materials[0].number, found.volume);
      add(materials[1].number, 1 - found.volume);
      if (growth) exchange(materials[0], materials[1], found.growth);
      return;
    }
    // For each pair, the region where both are above all others is divided between the two.
    double rest = 1;
    for (std::size_t m = 0; m + 1 < count; ++m) {
      double own = 0;
      for (std::size_t n = growth ? m + 1 : count - 1; n < count; ++n) {
        const PositivePart found = first_of_two(materials, m, n);
        own = found.volume;
        if (growth) exchange(materials[m], materials[n], found.growth);
      }
      add(materials[m].number, own);
      rest -= own;
    }
    add(materials.back().number, rest);
  }

 private:
  static std::array<double, 4> difference(const CornerValues& a, const CornerValues& b) {
    return {a.values[0] - b.values[0], a.values[1] - b.values[1], a.values[2] - b.values[2],
            a.values[3] - b.values[3]};
  }

  PositivePart first_of_two(const std::vector<CornerValues>& materials, std::size_t m, std::size_t n) {
    pieces_.assign(1, kWholeTetrahedron);
    for (std::size_t l = 0; l < materials.size(); ++l) {
      if (l != m && l != n) keep_positive(difference(materials[m], materials[l]), pieces_, scratch_);
    }
    return positive_part_of<true>(pieces_, difference(materials[m], materials[n]));
  }

  std::vector<TetrahedronPiece> pieces_, scratch_;
};

}  // namespace adamas::interfaces
