#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "isosurface/preprocessing/lod_values.h"
#include "isosurface/preprocessing/octant_stencils.h"
#include "isosurface/volume/page.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// The type of computations with samples. All sums of integers of up to 16 bits with small weights are exact
/// in a float.
template <class Sample>
using RealOf = std::conditional_t<std::is_same_v<Sample, float>, double, float>;

/// The samples of a cube of 16^3 cells, in the form that its tetrahedra need.
template <class Sample>
struct CubeSamples {
  using Real = RealOf<Sample>;
  using Word = OrderedWord<Sample>;
  static constexpr int kCube = OctantStencils::kCube;
  template <class T>
  using Octants = std::array<T, OctantStencils::kPoints * OctantStencils::kOctants>;

  LatticePoint base{};  ///< the cube's first corner
  /// The samples by point of an octant, then octant. `value` is interpolated; `counted` is compared with the
  /// interpolation, NaN beyond the data and infinite where a sample of the data is not finite.
  alignas(64) Octants<Real> value, counted;
  /// The counted samples, i running fastest.
  std::array<Real, kCube * kCube * kCube> whole;
  bool all_count = false;  ///< whether `counted` is not filled, since it equals `value`

  /// Returns whether all samples are equal, so that there is no error.
  [[nodiscard]] bool is_constant() const {
    return all_count && std::all_of(whole.begin(), whole.end(), [this](Real s) { return s == whole[0]; });
  }

  void load(const LodValues<Word>& samples, LatticePoint last, LatticePoint first) {
    base = first;
    all_count =
        std::is_integral_v<Sample> && base.i + 16 <= last.i && base.j + 16 <= last.j && base.k + 16 <= last.k;
    for (std::int32_t k = 0; k < kCube; ++k) {
      for (std::int32_t j = 0; j < kCube; ++j) {
        const bool is_inside = base.j + j <= last.j && base.k + k <= last.k;
        load_row(samples.samples(std::min(base.j + j, last.j), std::min(base.k + k, last.k)),
                 is_inside ? last.i : -1, last.i, j, k);
      }
    }
  }

 private:
  using Row = std::array<Real, kCube>;

  /// Loads a row. `last_counted` is the last sample of the row that is in the data.
  void load_row(const Word* row, std::int32_t last_counted, std::int32_t last, std::int32_t j,
                std::int32_t k) {
    Row values;
    if (base.i + kCube - 1 <= last) {
      for (std::size_t i = 0; i < kCube; ++i) values[i] = real(row[base.i + static_cast<std::int32_t>(i)]);
    } else {
      for (std::int32_t i = 0; i < kCube; ++i)
        values[static_cast<std::size_t>(i)] = real(row[std::min(base.i + i, last)]);
    }
    scatter(values, value, j, k);
    if (!all_count) {
      for (std::int32_t i = 0; i < kCube; ++i) {
        Real& v = values[static_cast<std::size_t>(i)];
        if (base.i + i > last_counted) {
          v = std::numeric_limits<Real>::quiet_NaN();
        } else if (std::is_same_v<Sample, float> && !std::isfinite(v)) {
          v = std::numeric_limits<Real>::infinity();
        }
      }
      scatter(values, counted, j, k);
    }
    std::copy(values.begin(), values.end(), whole.begin() + kCube * (j + kCube * k));
  }

  static Real real(Word word) { return static_cast<Real>(from_ordered<Sample>(word)); }

  /// Copies a row into the octants, mirrored in those behind the cube's centre; the planes through the centre
  /// are in both.
  static void scatter(const Row& values, Octants<Real>& to, std::int32_t j, std::int32_t k) {
    for (const int behind_k : {0, 1}) {
      if (behind_k == 0 ? k > 8 : k < 8) continue;
      for (const int behind_j : {0, 1}) {
        if (behind_j == 0 ? j > 8 : j < 8) continue;
        const std::int32_t y = behind_j == 0 ? j : 16 - j, z = behind_k == 0 ? k : 16 - k;
        Real* octants = to.data() + 8 * OctantStencils::place({0, y, z}) + 2 * behind_j + 4 * behind_k;
        for (std::size_t x = 0; x < 9; ++x) {
          octants[8 * x] = values[x];
          octants[8 * x + 1] = values[16 - x];
        }
      }
    }
  }
};

}  // namespace adamas::isosurface
