#include "isosurface/preprocessing/coarse_errors.h"

#include <algorithm>

#include "core/base/assert.h"
#include "core/geometry/tetrahedron.h"
#include "core/lattice/diamond.h"

namespace adamas::isosurface {

namespace {

Vec3 place_of(LatticePoint p) {
  return {static_cast<double>(p.i), static_cast<double>(p.j), static_cast<double>(p.k)};
}

}  // namespace

LeafPoints::LeafPoints() {
  constexpr int kShift = kRootBits - 4;
  for (int n = 0; n < 27; ++n) {
    const LatticePoint p{8 * (n % 3), 8 * (n / 3 % 3), 8 * (n / 9)};
    if (trailing_zeros(p) != 3) continue;
    const Diamond diamond({p.i << kShift, p.j << kShift, p.k << kShift});
    if (diamond.phase() != 2) continue;
    for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
      Leaf leaf{diamond.tetrahedron(slot), p, static_cast<std::uint32_t>(places_[0].size()), 0};
      bool is_inside = true;
      for (LatticePoint& c : leaf.corners) {
        is_inside = is_inside && std::min({c.i, c.j, c.k}) >= 0 && std::max({c.i, c.j, c.k}) >> kShift <= 16;
        c = {c.i >> kShift, c.j >> kShift, c.k >> kShift};
      }
      if (!is_inside) continue;
      const Tetrahedron cell({place_of(leaf.corners[0]), place_of(leaf.corners[1]), place_of(leaf.corners[2]),
                              place_of(leaf.corners[3])});
      for (int m = 0; m < 17 * 17 * 17; ++m) {
        const LatticePoint q{m % 17, m / 17 % 17, m / 289};
        // Weights are multiples of 1 / 16, so that nothing is rounded.
        const Weights w = cell.weights(place_of(q));
        if (std::min({w[0], w[1], w[2], w[3]}) >= 0) add(q);
      }
      while (places_[0].size() % kPadding != 0) add(p);
      leaf.last = static_cast<std::uint32_t>(places_[0].size());
      leaves_.push_back(leaf);
    }
  }
  ADAMAS_ASSERT(leaves_.size() == kLeaves);
}

void LeafPoints::add(LatticePoint p) {
  for (int axis = 0; axis < 3; ++axis) {
    floats_[static_cast<std::size_t>(axis)].push_back(static_cast<float>(p[axis]));
    doubles_[static_cast<std::size_t>(axis)].push_back(p[axis]);
  }
  for (int mirrored = 0; mirrored < 8; ++mirrored) {
    LatticePoint q = p;
    for (int axis = 0; axis < 3; ++axis) {
      if ((mirrored >> axis & 1) != 0) q[axis] = 16 - q[axis];
    }
    places_[static_cast<std::size_t>(mirrored)].push_back(
        static_cast<std::uint16_t>(q.i + 17 * (q.j + 17 * q.k)));
  }
}

}  // namespace adamas::isosurface
