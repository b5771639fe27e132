#include "isosurface/preprocessing/tetrahedron_stencils.h"

#include "core/geometry/tetrahedron.h"

namespace adamas {

TetrahedronStencils::TetrahedronStencils(const std::array<std::int32_t, 3>& count)
    : strides_{1, count[0], std::ptrdiff_t{count[0]} * count[1]} {
  for (int bits = 0; bits < kScales; ++bits) {
    for (const DiamondType& type : kDiamondTypes) {
      for (int slot = 0; slot < 8; ++slot) {
        stencils_.push_back(slot < type.tetrahedron_count ? make(bits, type, slot) : Stencil{});
      }
    }
  }
}

TetrahedronStencils::Stencil TetrahedronStencils::make(int scale_bits, const DiamondType& type, int slot) {
  const std::int32_t scale = std::int32_t{1} << scale_bits;
  const auto ring = [&](int s) { return type.ring[static_cast<std::size_t>(s % type.tetrahedron_count)]; };
  const std::array<LatticePoint, 4> corners{-scale * type.direction, scale * type.direction,
                                            scale * ring(slot), scale * ring(slot + 1)};
  const auto offset = [this](LatticePoint p) {
    return p.i * strides_[0] + p.j * strides_[1] + p.k * strides_[2];
  };
  const auto place = [](LatticePoint p) {
    return Vec3{static_cast<double>(p.i), static_cast<double>(p.j), static_cast<double>(p.k)};
  };
  const Tetrahedron cell({place(corners[0]), place(corners[1]), place(corners[2]), place(corners[3])});
  Stencil stencil;
  for (std::size_t c = 0; c < 4; ++c) stencil.corners[c] = offset(corners[c]);
  stencil.first = static_cast<std::uint32_t>(points_.size());
  for (std::int32_t k = -scale; k <= scale; ++k) {
    for (std::int32_t j = -scale; j <= scale; ++j) {
      for (std::int32_t i = -scale; i <= scale; ++i) {
        // Multiples of 1 / (2 scale), so that nothing is rounded.
        const Weights w = cell.weights(place({i, j, k}));
        if (std::min({w[0], w[1], w[2], w[3]}) < 0 || std::max({w[0], w[1], w[2], w[3]}) == 1) continue;
        points_.push_back({offset({i, j, k}), w});
      }
    }
  }
  stencil.last = static_cast<std::uint32_t>(points_.size());
  return stencil;
}

}  // namespace adamas
