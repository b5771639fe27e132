#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/vec3.h"
#include "isosurface/gradients/gradient_estimator.h"
#include "isosurface/gradients/octahedral_codes.h"

namespace adamas::isosurface {

/// Gradients of all samples of a plane, from three planes of a volume: those of GradientEstimator up to
/// rounding, by sums along rows where all neighbours are there and finite. Sample is std::uint8_t,
/// std::uint16_t, std::int16_t or float.
class PlaneGradients {
 public:
  /// `spacing`: between samples, positive. Planes have nx x ny samples, i running fastest.
  PlaneGradients(const Vec3& spacing, std::size_t nx, std::size_t ny);

  /// Of planes[1]; of its neighbours planes[0] and planes[2] either may be null, beyond the first and the
  /// last plane. Same results on any number of threads; gradients beyond the range of float become
  /// infinite.
  template <class Sample>
  void operator()(const std::array<const Sample*, 3>& planes, std::span<Gradient> gradients) const;
  /// Their directions alone.
  template <class Sample>
  void operator()(const std::array<const Sample*, 3>& planes, std::span<OctahedralCode> codes) const;

 private:
  /// What a step along an axis, alone or with steps along others, counts for in the gradient's component.
  struct Weights {
    double alone, with_first, with_second, with_both;
  };
  /// The components for one row.
  struct Row {
    std::vector<double> x, y, z;
  };
  template <class Sample>
  class RowSums;

  template <class Sample>
  void row(const std::array<const Sample*, 3>& planes, std::size_t j, RowSums<Sample>& sums, Row& to) const;
  /// The gradient at (i, j) by the estimator.
  template <class Sample>
  [[nodiscard]] Vec3 single(const std::array<const Sample*, 3>& planes, std::size_t i, std::size_t j) const;
  /// Calls store(j, row) for all rows, on several threads.
  template <class Sample, class Store>
  void for_each_row(const std::array<const Sample*, 3>& planes, Store&& store) const;

  GradientEstimator estimate_;
  std::size_t nx_, ny_;
  std::array<Weights, 3> weights_;  ///< of each axis; the others are first and second in ascending order
};

}  // namespace adamas::isosurface
