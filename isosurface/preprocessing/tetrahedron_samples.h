#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/lattice/lattice_point.h"

namespace adamas {

/// A box of samples in memory, i running fastest.
template <class Sample>
struct SampleBlock {
  LatticePoint first{};                 ///< of the volume's samples, that which comes first here
  std::array<std::int32_t, 3> count{};  ///< per axis
  const Sample* samples = nullptr;

  [[nodiscard]] const Sample* row(std::int32_t j, std::int32_t k) const {
    return samples + (static_cast<std::ptrdiff_t>(k - first.k) * count[1] + (j - first.j)) * count[0];
  }
};

/// What is said of samples: how far they are from a linear interpolation, and their range. Non-finite ones do
/// not count.
struct SampleDeviation {
  double error = 0;
  double min = std::numeric_limits<double>::infinity(), max = -std::numeric_limits<double>::infinity();
};

/// The lattice points inside and on a tetrahedron whose corners are lattice points, row by row.
class TetrahedronRows {
 public:
  using Corners = std::array<LatticePoint, 4>;

  explicit TetrahedronRows(const Corners& corners);

  /// Adds what is known of the samples of a block that lie in the tetrahedron, as seen from the linear
  /// interpolation of these values at its corners. With integer samples of up to 16 bits and a tetrahedron
  /// made by bisection nothing is rounded.
  template <class Sample>
  void measure(const SampleBlock<Sample>& block, const std::array<double, 4>& values,
               SampleDeviation& result) const;

 private:
  /// Points of [begin, end) of the row at (j, k) are inside.
  struct Row {
    std::int32_t begin, end;
  };
  /// A linear function with integer coefficients: 0 on the face opposite to a corner, `height` at the corner.
  struct Face {
    std::int64_t i, j, k, constant, height;
    [[nodiscard]] std::int64_t at(std::int64_t x, std::int64_t y, std::int64_t z) const {
      return i * x + j * y + k * z + constant;
    }
  };

  [[nodiscard]] Row row(std::int32_t j, std::int32_t k, std::int32_t begin, std::int32_t end) const;

  std::array<Face, 4> faces_;
  LatticePoint low_{}, high_{};  ///< the bounding box, both included
};

template <class Sample>
void TetrahedronRows::measure(const SampleBlock<Sample>& block, const std::array<double, 4>& values,
                              SampleDeviation& result) const {
  const auto first = [&](int axis) { return std::max(low_[axis], block.first[axis]); };
  const auto end = [&](int axis) {
    return std::min(high_[axis] + 1, block.first[axis] + block.count[static_cast<std::size_t>(axis)]);
  };
  double slope = 0;
  for (std::size_t m = 0; m < 4; ++m)
    slope += values[m] * static_cast<double>(faces_[m].i) / static_cast<double>(faces_[m].height);
  for (std::int32_t k = first(2); k < end(2); ++k) {
    for (std::int32_t j = first(1); j < end(1); ++j) {
      const Row inside = row(j, k, first(0), end(0));
      if (inside.begin >= inside.end) continue;
      double start = 0;
      for (std::size_t m = 0; m < 4; ++m)
        start += values[m] * (static_cast<double>(faces_[m].at(inside.begin, j, k)) /
                              static_cast<double>(faces_[m].height));
      const Sample* samples = block.row(j, k) + (inside.begin - block.first.i);
      for (std::int32_t i = 0; i < inside.end - inside.begin; ++i) {
        const double sample = samples[i];
        if constexpr (std::is_floating_point_v<Sample>) {
          if (!std::isfinite(sample)) continue;
        }
        result.error = std::max(result.error, std::abs(start + slope * i - sample));
        result.min = std::min(result.min, sample);
        result.max = std::max(result.max, sample);
      }
    }
  }
}

}  // namespace adamas
