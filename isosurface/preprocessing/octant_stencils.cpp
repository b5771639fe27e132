#include "isosurface/preprocessing/octant_stencils.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/tetrahedron.h"
#include "core/lattice/diamond.h"
#include "isosurface/volume/error_scale.h"

namespace adamas::isosurface {

namespace {

using Corners = std::array<LatticePoint, 4>;

int squared(LatticePoint p) { return p.i * p.i + p.j * p.j + p.k * p.k; }

int axis_of(LatticePoint step) { return step.i != 0 ? 0 : step.j != 0 ? 1 : 2; }

Vec3 place_of(LatticePoint p) {
  return {static_cast<double>(p.i), static_cast<double>(p.j), static_cast<double>(p.k)};
}

/// Returns the corners in the order of Shape, in units of the scale.
Corners ordered_corners(const DiamondType& type, int slot) {
  const auto ring = [&](int s) { return type.ring[static_cast<std::size_t>(s % type.tetrahedron_count)]; };
  const LatticePoint a = -type.direction, b = type.direction;
  LatticePoint r = ring(slot), q = ring(slot + 1);
  if (type.phase == 0) {
    if (squared(r - a) > 4) std::swap(r, q);
    return {a, r, q, b};
  }
  if (type.phase == 1) {
    if (squared(r) == 1) std::swap(r, q);
    return {a, r, b, q};
  }
  if (squared(r) == 2) std::swap(r, q);
  return {a, b, r, q};
}

std::array<std::int32_t, 3> step_axes(const Corners& c, int phase) {
  std::array<std::int32_t, 3> axes{};
  axes[0] = axis_of(c[1] - c[0]);
  axes[1] = phase == 2 ? axis_of(c[2]) : axis_of(c[2] - c[1]);
  axes[2] = 3 - axes[0] - axes[1];
  return axes;
}

}  // namespace

OctantStencils::OctantStencils(int depth, const Vec3& spacing) : octants_(depth > 3 ? kOctants : 1) {
  const int bits = std::min(depth, 3);
  for (int scale_bits = kLeastBits; scale_bits < bits; ++scale_bits) add_shapes(scale_bits, spacing);
  add_diamonds(bits);
}

void OctantStencils::add_shapes(int scale_bits, const Vec3& spacing) {
  const double greatest = lod_error_scale(spacing, scale_bits).greatest();
  for (const DiamondType& type : kDiamondTypes) {
    for (int slot = 0; slot < 8; ++slot) {
      Shape shape{};
      if (slot < type.tetrahedron_count) {
        Corners corners = ordered_corners(type, slot);
        shape.axes = step_axes(corners, type.phase);
        for (LatticePoint& c : corners) c = (1 << scale_bits) * c;
        for (std::size_t c = 0; c < 4; ++c) shape.corners[c] = place(corners[c]);
        const double ratio = world_diameter(corners, spacing) / greatest;
        shape.diameter = static_cast<float>(ratio * ratio);
        shape.first = static_cast<std::uint32_t>(points_.size());
        add_points(corners, 1 << scale_bits);
        shape.last = static_cast<std::uint32_t>(points_.size());
      }
      shapes_.push_back(shape);
    }
  }
}

void OctantStencils::add_points(const std::array<LatticePoint, 4>& corners, std::int32_t scale) {
  const Tetrahedron cell(
      {place_of(corners[0]), place_of(corners[1]), place_of(corners[2]), place_of(corners[3])});
  for (std::int32_t k = -scale; k <= scale; ++k) {
    for (std::int32_t j = -scale; j <= scale; ++j) {
      for (std::int32_t i = -scale; i <= scale; ++i) {
        // Weights are multiples of 1 / (2 scale), so that nothing is rounded.
        const Weights w = cell.weights(place_of({i, j, k}));
        if (std::min({w[0], w[1], w[2], w[3]}) < 0 || std::max({w[0], w[1], w[2], w[3]}) == 1) continue;
        const auto weight = [&w](std::size_t c) { return static_cast<float>(w[c]); };
        points_.push_back({place({i, j, k}), {weight(0), weight(1), weight(2), weight(3)}});
      }
    }
  }
}

void OctantStencils::add_diamonds(int bits) {
  const int shift = kRootBits - bits;
  const std::int32_t side = std::int32_t{1} << bits;
  const auto is_inside = [side](LatticePoint p) {
    return std::min({p.i, p.j, p.k}) >= 0 && std::max({p.i, p.j, p.k}) <= side;
  };
  for (int n = 0; n < kPoints; ++n) {
    const LatticePoint p{n % kSide, n / kSide % kSide, n / kSide / kSide};
    const int scale_bits = trailing_zeros(p);
    if (!is_inside(p) || scale_bits < kLeastBits || scale_bits >= bits) continue;
    const Diamond diamond({p.i << shift, p.j << shift, p.k << shift});
    SmallDiamond small{place(p), diamond.phase(), static_cast<std::uint32_t>(shape_indices_.size()), 0};
    for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
      const Corners corners = ordered_corners(diamond.type(), slot);
      if (!std::all_of(corners.begin(), corners.end(),
                       [&](LatticePoint c) { return is_inside(p + (1 << scale_bits) * c); }))
        continue;
      shape_indices_.push_back(static_cast<std::uint16_t>(
          ((scale_bits - kLeastBits) * kDiamondTypeCount + diamond.type_index()) * 8 + slot));
    }
    small.last = static_cast<std::uint32_t>(shape_indices_.size());
    diamonds_.push_back(small);
  }
}

}  // namespace adamas::isosurface
