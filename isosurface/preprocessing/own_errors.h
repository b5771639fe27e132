#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "adamas/geometry.h"
#include "core/lattice/lattice_point.h"

namespace adamas::isosurface {

/// Returns the square of the factor, for each axis, from a slope per sample to the ratio of the finest LOD's
/// greatest error to the distance over which a value changes by one. `spacing` is that of the samples.
std::array<double, 3> slope_factors(const Vec3& spacing);

/// The data of own errors besides the samples.
struct OwnErrorGeometry {
  explicit OwnErrorGeometry(const Vec3& spacing);

  std::array<double, 3> slope_factors;
  /// Squared ratios of the diameters to the LOD's greatest error: of the tetrahedra round edges along an
  /// axis, of those round faces across it, and of those in cubes.
  std::array<float, 3> edge_diameters, face_diameters;
  float centre_diameter;
};

// The own error of a diamond is the greatest error of its tetrahedra, without those of its children. The
// functions below compute it from samples for the diamonds of the finest LOD: when a volume is preprocessed,
// and again when a page is decoded, since values that follow from the samples are not stored. Both have to
// find the same codes, bit for bit, on every machine: the only operations are +, -, *, / and comparisons of
// floats as in IEEE 754, each rounded by itself, in the written order.

/// Numbers of 16^3 points and of those one step round them: coordinates from -1 to 16. In each row along i
/// the points with an odd coordinate come first, then those with an even one, so that points of one kind are
/// consecutive.
template <class Real>
class SampleBlock {
 public:
  static constexpr std::int32_t kPoints = 16;
  static constexpr std::ptrdiff_t kHalf = 9, kSide = 2 * kHalf;

  void fill(Real number) { numbers_.fill(number); }

  [[nodiscard]] const Real* at(LatticePoint q) const { return numbers_.data() + index(q); }
  [[nodiscard]] Real* at(LatticePoint q) { return numbers_.data() + index(q); }
  [[nodiscard]] const auto& numbers() const { return numbers_; }

  /// The steps from a point to its neighbours before and behind it along an axis.
  struct Steps {
    std::ptrdiff_t before, after;
  };
  static constexpr Steps steps(LatticePoint from, int axis) {
    if (axis == 0) return (from.i & 1) != 0 ? Steps{kHalf - 1, kHalf} : Steps{-kHalf, 1 - kHalf};
    const std::ptrdiff_t step = axis == 1 ? kSide : kSide * kSide;
    return {-step, step};
  }

 private:
  static constexpr std::size_t index(LatticePoint q) {
    const std::ptrdiff_t i = (q.i & 1) != 0 ? (q.i + 1) / 2 : kHalf + q.i / 2;
    return static_cast<std::size_t>(i + kSide * ((q.j + 1) + kSide * (q.k + 1)));
  }

  std::array<Real, kSide * kSide * kSide> numbers_;
};

/// Error codes of 16^3 points: in each row along i first those of even coordinates, then those of odd ones.
class OwnErrorCodes {
 public:
  [[nodiscard]] std::uint8_t* even(std::int32_t j, std::int32_t k) { return codes_.data() + row(j, k); }
  [[nodiscard]] std::uint8_t* odd(std::int32_t j, std::int32_t k) { return even(j, k) + 8; }

 private:
  static std::size_t row(std::int32_t j, std::int32_t k) {
    return static_cast<std::size_t>(16 * (j + 16 * k));
  }

  std::array<std::uint8_t, 4096> codes_;
};

/// Computes codes of the own errors of a block's points of the finest LOD, up to `count` along each axis;
/// rows are filled whole, with undefined codes behind `count`; the code is 0 where all coordinates are even.
/// The block begins at a multiple of four.
///
/// `samples`: the interpolated samples. `counted`: the samples that are compared with the interpolation; NaN
/// where a sample does not count, infinite where nothing stands for it. Both may be the same, and are known
/// one step round the points.
///
/// Real: float, for integers of up to 16 bits, where only products and quotients are rounded; or double, for
/// any floats: there errors are raised by more than rounding may reduce them, and are the greatest of the LOD
/// where a sample is not finite.
template <class Real>
void own_errors(const SampleBlock<Real>& samples, const SampleBlock<Real>& counted,
                const OwnErrorGeometry& geometry, LatticePoint count, OwnErrorCodes& codes);

}  // namespace adamas::isosurface
