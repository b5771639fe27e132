#pragma once

#include <array>
#include <cstdint>

#include "adamas/geometry.h"
#include "core/lattice/lattice_point.h"

namespace adamas::isosurface {

/// Errors in six bits on a logarithmic scale (D 4.3), one scale for each LOD: code 0 is no error, the
/// greatest code the greatest error, and each code is 2^(1/4) times the one before. Codes are never smaller
/// than the error.
class ErrorScale {
 public:
  static constexpr int kCodes = 64;

  /// Makes a scale. `greatest` is the greatest of the LOD's errors; it is finite and not negative.
  explicit ErrorScale(double greatest);

  /// Returns the least code whose error is not less than `error`; the greatest code for errors beyond the
  /// scale and for NaN.
  [[nodiscard]] std::uint8_t encode(double error) const;
  [[nodiscard]] double decode(std::uint8_t code) const { return errors_[code]; }
  [[nodiscard]] double greatest() const { return errors_.back(); }

 private:
  std::array<double, kCodes> errors_{};  ///< the errors of the codes, ascending
};

/// Returns the error scale of an LOD: its greatest error is the greatest diameter of the tetrahedra of the
/// diamonds whose scale is 2^lod samples.
ErrorScale lod_error_scale(const Vec3& spacing, int lod);

/// Returns the error class of a code of an LOD's scale. Classes unite the scales of all LODs: class 0 is no
/// error, and each class is an error 2^(1/4) times that of the class before. Scales of neighbouring LODs
/// differ by a factor of two, so that equal errors of all LODs have the same class.
constexpr int error_class(int code, int lod) { return code == 0 ? 0 : code + 4 * lod; }

/// Returns the greatest distance between two corners of a tetrahedron, where samples lie `spacing` apart.
double world_diameter(const std::array<LatticePoint, 4>& corners, const Vec3& spacing);

}  // namespace adamas::isosurface
