#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/base/simd.h"
#include "isosurface/preprocessing/cube_samples.h"
#include "isosurface/preprocessing/error_code.h"
#include "isosurface/preprocessing/octant_stencils.h"
#include "isosurface/preprocessing/own_errors.h"

namespace adamas::isosurface {

/// Own errors of the diamonds of scales 2 and 4, as far as their tetrahedra lie in one cube of 16^3 cells.
template <class Sample>
class OctantErrors {
 public:
  using Real = RealOf<Sample>;
  static constexpr int kCube = OctantStencils::kCube;
  /// The error codes of the cube's points, i running fastest.
  using Codes = std::array<std::uint8_t, kCube * kCube * kCube>;

  OctantErrors(const OctantStencils& stencils, const Vec3& spacing) : stencils_(stencils) {
    for (int n = 0; n < OctantStencils::kPoints; ++n) {
      const LatticePoint p{n % 9, n / 9 % 9, n / 81};
      for (int octant = 0; octant < 8; ++octant) {
        const auto at = [octant](int x, int axis) { return (octant >> axis & 1) != 0 ? 16 - x : x; };
        places_[static_cast<std::size_t>(8 * n + octant)] =
            static_cast<std::uint16_t>(at(p.i, 0) + kCube * (at(p.j, 1) + kCube * at(p.k, 2)));
      }
    }
    const std::array<double, 3> factors = slope_factors(spacing);
    for (std::size_t axis = 0; axis < 3; ++axis) factors_[axis] = static_cast<Real>(factors[axis]);
  }

  void measure(const CubeSamples<Sample>& cube, Codes& codes) const {
    codes.fill(0);
    const Real* value = cube.value.data();
    const Real* counted = cube.all_count ? value : cube.counted.data();
    for (const OctantStencils::SmallDiamond& diamond : stencils_.diamonds()) {
      const std::ptrdiff_t first = std::ptrdiff_t{8} * diamond.place;
      alignas(16) std::array<Real, 8> squared;
      for (std::size_t lane = 0; lane < 8; lane += Vector::kCount) {
        const auto at = first + static_cast<std::ptrdiff_t>(lane);
        Vector::store(by_phase(diamond, value + at, counted + at), squared.data() + lane);
      }
      for (int octant = 0; octant < stencils_.octants(); ++octant) {
        std::uint8_t& code = codes[places_[static_cast<std::size_t>(first + octant)]];
        code = std::max(code, error_code(squared[static_cast<std::size_t>(octant)]));
      }
    }
  }

 private:
  using Vector = Simd<Real, 16>;
  using Lanes = typename Vector::Numbers;

  /// The samples at the four corners of a tetrahedron.
  struct Corners {
    Lanes at[4];
    const Lanes& operator[](std::size_t n) const { return at[n]; }
  };

  Lanes by_phase(const OctantStencils::SmallDiamond& diamond, const Real* value, const Real* counted) const {
    switch (diamond.phase) {
      case 0:
        return squared_ratio<0>(diamond, value, counted);
      case 1:
        return squared_ratio<1>(diamond, value, counted);
      default:
        return squared_ratio<2>(diamond, value, counted);
    }
  }

  /// Returns the squared ratio of the error to the scale's greatest one.
  template <int Phase>
  Lanes squared_ratio(const OctantStencils::SmallDiamond& diamond, const Real* value,
                      const Real* counted) const {
    Lanes greatest{};
    const Lanes zero{};
    for (std::uint32_t n = diamond.first; n < diamond.last; ++n) {
      const OctantStencils::Shape& shape = stencils_.shapes()[stencils_.shape_indices()[n]];
      Corners corners;
      for (std::size_t c = 0; c < 4; ++c) corners.at[c] = Vector::load(value + 8 * shape.corners[c]);
      Lanes error = difference(shape, corners, counted);
      if constexpr (std::is_same_v<Sample, float>) error = widened(error, corners);
      const Lanes ratio = error * error / slope<Phase>(shape, corners);
      const Lanes diameter = zero + static_cast<Real>(shape.diameter);
      Lanes bounded = ratio < diameter ? ratio : diameter;
      bounded = error > zero ? bounded : zero;
      if constexpr (std::is_same_v<Sample, float>) {
        // The error is the scale's greatest if a corner or another sample is not finite.
        const Lanes sum = zero * (corners[0] + corners[1] + corners[2] + corners[3] + error);
        bounded = sum == zero ? bounded : zero + 1;
      }
      greatest = Vector::greater(greatest, bounded);
    }
    return greatest;
  }

  /// Returns the greatest difference e_a between the tetrahedron's samples and the interpolation of its
  /// corners; infinite where a sample that is no corner is not finite.
  Lanes difference(const OctantStencils::Shape& shape, const Corners& corners, const Real* counted) const {
    Lanes greatest{};
    const OctantStencils::Point* points = stencils_.points().data();
    for (std::uint32_t n = shape.first; n < shape.last; ++n) {
      const auto& [offset, w] = points[n];
      const Lanes linear = corners[0] * static_cast<Real>(w[0]) + corners[1] * static_cast<Real>(w[1]) +
                           corners[2] * static_cast<Real>(w[2]) + corners[3] * static_cast<Real>(w[3]);
      const Lanes above = linear - Vector::load(counted + std::ptrdiff_t{8} * offset);
      greatest = Vector::greater(Vector::greater(greatest, above), -above);
    }
    return greatest;
  }

  /// Returns the error, raised by more than rounding may have reduced it.
  static Lanes widened(Lanes error, const Corners& corners) {
    Lanes sum{};
    for (const Lanes& corner : corners.at) sum += Vector::greater(corner, -corner);
    const Lanes zero{};
    return error > zero ? error + sum * static_cast<Real>(0x1p-49) : zero;
  }

  /// Returns the square of the gradient, scaled by slope_factors().
  template <int Phase>
  Lanes slope(const OctantStencils::Shape& shape, const Corners& c) const {
    constexpr Real kHalf = static_cast<Real>(0.5);
    Lanes steps[3];
    steps[0] = (c[1] - c[0]) * kHalf;
    steps[1] = Phase == 2 ? c[2] - (c[0] + c[1]) * kHalf : (c[2] - c[1]) * kHalf;
    steps[2] = Phase == 0 ? (c[3] - c[2]) * kHalf : Phase == 1 ? c[3] - (c[0] + c[2]) * kHalf : c[3] - c[2];
    Lanes sum{};
    for (std::size_t n = 0; n < 3; ++n) sum += steps[n] * steps[n] * factors_[shape.axes[n]];
    return sum;
  }

  const OctantStencils& stencils_;
  std::array<std::uint16_t, 8 * OctantStencils::kPoints> places_{};
  Real factors_[3]{};
};

}  // namespace adamas::isosurface
