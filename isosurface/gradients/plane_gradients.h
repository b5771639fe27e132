#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/progress.h"
#include "adamas/volume.h"
#include "isosurface/gradients/gradient_estimator.h"
#include "isosurface/gradients/octahedral_codes.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// Computes gradients of all samples of a plane from three planes of a volume: those of GradientEstimator up
/// to rounding, by sums along rows if all neighbours exist and are finite. Sample is std::uint8_t,
/// std::uint16_t, std::int16_t or float.
class PlaneGradients {
 public:
  /// Makes the object. `spacing` is the distance between samples along each axis, positive. Planes have nx x
  /// ny samples, i running fastest.
  PlaneGradients(const Vec3& spacing, std::size_t nx, std::size_t ny);

  /// Fills the gradients of planes[1]. Its neighbours planes[0] and planes[2] may be null, beyond the first
  /// and the last plane. Results are the same on any number of threads; gradients beyond the range of float
  /// become infinite.
  template <class Sample>
  void operator()(const std::array<const Sample*, 3>& planes, std::span<Gradient> gradients) const;
  /// Fills only the directions of these gradients.
  template <class Sample>
  void operator()(const std::array<const Sample*, 3>& planes, std::span<OctahedralCode> codes) const;

 private:
  /// The weights of differences in a component of the gradient: of steps along its axis alone, and of steps
  /// along others too.
  struct Weights {
    double alone, with_first, with_second, with_both;
  };
  /// The components of the gradients of one row.
  struct Row {
    std::vector<double> x, y, z;
  };
  template <class Sample>
  class RowSums;

  template <class Sample>
  void row(const std::array<const Sample*, 3>& planes, std::size_t j, RowSums<Sample>& sums, Row& to) const;
  /// Returns the gradient at (i, j) by the estimator.
  template <class Sample>
  [[nodiscard]] Vec3 single(const std::array<const Sample*, 3>& planes, std::size_t i, std::size_t j) const;
  /// Calls store(j, row) for all rows, on several threads.
  template <class Sample, class Store>
  void for_each_row(const std::array<const Sample*, 3>& planes, Store&& store) const;

  GradientEstimator estimate_;
  std::size_t nx_, ny_;
  /// Weights by axis; the other axes are first and second in ascending order.
  std::array<Weights, 3> weights_;
};

/// Calls fn({below, plane, above}) with the samples of each plane of a volume and of its neighbours, in
/// ascending order; null beyond the first and the last. Every plane is read once.
template <class Sample, class Fn>
void for_each_three_planes(const VolumeGrid& grid, const PlaneSource& planes, const char* stage, Fn&& fn,
                           Progress& progress) {
  const std::uint64_t nz = grid.dimensions[2];
  // Plane k lies at k % 3.
  std::array<std::vector<Sample>, 3> samples;
  for (auto& plane : samples) plane.resize(grid.plane_samples());
  const auto read = [&](std::uint64_t k) { planes(k, std::as_writable_bytes(std::span(samples[k % 3]))); };
  read(0);
  for (std::uint64_t k = 0; k < nz; ++k) {
    progress.step(stage, static_cast<double>(k) / static_cast<double>(nz));
    if (k + 1 < nz) read(k + 1);
    const Sample* below = k > 0 ? samples[(k + 2) % 3].data() : nullptr;
    const Sample* above = k + 1 < nz ? samples[(k + 1) % 3].data() : nullptr;
    fn(std::array<const Sample*, 3>{below, samples[k % 3].data(), above});
  }
}

}  // namespace adamas::isosurface
