#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "adamas/geometry.h"
#include "core/lattice/lattice_point.h"

namespace adamas::isosurface {

/// Factors for each axis: the square of what turns a slope, per sample, into the ratio of the finest LOD's
/// greatest error to the distance over which a value changes by one. `spacing` is that of the samples.
std::array<double, 3> slope_factors(const Vec3& spacing);

/// What own errors depend on beside the samples.
struct OwnErrorGeometry {
  explicit OwnErrorGeometry(const Vec3& spacing);

  std::array<double, 3> slope_factors;
  /// Squares of the diameters' ratios to the LOD's greatest error: of the tetrahedra round edges along an
  /// axis, of those round faces across it, and of those in cubes.
  std::array<float, 3> edge_diameters, face_diameters;
  float centre_diameter;
};

// The own error of a diamond is the greatest error of its tetrahedra, without what its children have. Here it
// is worked out from samples for the diamonds of the finest LOD: when a volume is preprocessed, and again
// when a page is decoded, since what follows from the samples is not stored. Both have to find the same
// codes, bit for bit, on every machine: there are no operations but +, -, *, / and comparisons of floats as
// IEEE 754 has them, each rounded by itself, in the order that is written down.

/// Numbers of 16^3 points and of those one step round them: coordinates from -1 to 16. In each row along i
/// the points with an odd coordinate come first, then those with an even one, so that points of one kind
/// follow each other.
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

/// Codes of the own errors of a block's points of the finest LOD, up to `count` along each axis; rows are
/// filled whole, with anything behind `count`; 0 stands where all coordinates are even. The block begins at a
/// multiple of four.
///
/// `samples`: what is interpolated. `counted`: what it is compared with; NaN where a sample does not count,
/// infinite where nothing stands for it. May be the same. Both are known one step round the points.
///
/// Real: float, for whole numbers of up to 16 bits, where nothing but products and quotients is rounded; or
/// double, for any floats: there errors are raised by more than what rounding may take off, and are the
/// greatest of the LOD where a sample is not finite.
template <class Real>
void own_errors(const SampleBlock<Real>& samples, const SampleBlock<Real>& counted,
                const OwnErrorGeometry& geometry, LatticePoint count, OwnErrorCodes& codes);

}  // namespace adamas::isosurface
