#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "core/base/simd.h"
#include "isosurface/preprocessing/cube_samples.h"
#include "isosurface/preprocessing/lod_values.h"
#include "isosurface/preprocessing/own_errors.h"
#include "isosurface/volume/error_scale.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// Own errors of the diamonds of scale 1, in blocks of 16^3 points.
///
/// In a block of noise (is_noise), all diamonds have the greatest error of the LOD, and the same range, which
/// contains their samples (NoiseBounds).
template <class Sample>
class FinestErrors {
 public:
  using Real = RealOf<Sample>;
  using Word = OrderedWord<Sample>;
  struct Work {
    SampleBlock<Real> samples, counted;
    OwnErrorCodes codes;
  };

  /// Makes the object. `depth` is that of the lattice, `last` the last sample.
  FinestErrors(int depth, LatticePoint last, const Vec3& spacing)
      : side_(std::int32_t{1} << depth), last_(last), geometry_(spacing) {}

  /// Sets the codes of the LOD's points from `base` on, which were 0; the samples one step round them must be
  /// loaded. If the block is noise, it sets none and returns true: then set_noise() has to be called. `noise`
  /// is from least_noise().
  [[nodiscard]] bool measure(LodValues<Word>& lod, LatticePoint base, double noise, Work& work) const {
    LatticePoint count;
    bool all_count = std::is_integral_v<Sample>;
    for (int axis = 0; axis < 3; ++axis) {
      count[axis] = std::min(SampleBlock<Real>::kPoints, lod.size()[axis] - base[axis]);
      const std::int32_t end = base[axis] + count[axis];
      all_count = all_count && std::max(end - 1, inside(end)) <= last_[axis];
    }
    load(lod, base, count, all_count, work);
    if (all_count && count == LatticePoint{16, 16, 16} && is_constant(work.samples)) return false;
    if (is_noise(work.samples, base, count, noise)) return true;
    own_errors(work.samples, all_count ? work.samples : work.counted, geometry_, count, work.codes);
    for (std::int32_t k = 0; k < count.k; ++k) {
      for (std::int32_t j = 0; j < count.j; ++j) {
        using Lanes = EightLanes<std::uint8_t>;
        std::array<std::uint8_t, 16> row;
        Lanes::store_by_turns(Lanes::load(work.codes.even(j, k)), Lanes::load(work.codes.odd(j, k)),
                              row.data());
        std::copy_n(row.begin(), count.i, lod.codes(base.j + j, base.k + k) + base.i);
      }
    }
    return false;
  }

  /// Returns the least mean difference between samples and the mean of their two neighbours that is regarded
  /// as noise. The difference is 0.29 of the range for uniformly distributed samples, and a tenth of it for
  /// normally distributed ones. Integers have to use a good part of their words, since noise of fewer bits
  /// takes few bytes, bounds included. `low` and `high` are the range of the samples round here, as words.
  static double least_noise(Word low, Word high) {
    if constexpr (std::is_integral_v<Sample>) {
      return std::numeric_limits<Word>::max() / 4.0;
    } else {
      return low < high ? (real(high) - real(low)) / 12.0 : std::numeric_limits<double>::infinity();
    }
  }

  /// Gives all diamonds of a block of noise the greatest error and a range that contains all their samples.
  static void set_noise(LodValues<Word>& lod, LatticePoint base, Word low, Word high) {
    const LatticePoint size = lod.size();
    for (std::int32_t k = base.k; k < std::min(base.k + 16, size.k); ++k) {
      for (std::int32_t j = base.j; j < std::min(base.j + 16, size.j); ++j) {
        // Points with even coordinates alone belong to coarser LODs.
        const std::int32_t first = ((j | k) & 1) == 0 ? 1 : 0;
        for (std::int32_t i = base.i + first; i < std::min(base.i + 16, size.i); i += 1 + first) {
          lod.codes(j, k)[i] = ErrorScale::kCodes - 1;
          lod.low(j, k)[i] = low;
          lod.high(j, k)[i] = high;
        }
      }
    }
  }

 private:
  /// Blocks of fewer samples are never noise.
  static constexpr std::int32_t kLeastOfNoise = 64;

  static bool is_constant(const SampleBlock<Real>& block) {
    const auto& numbers = block.numbers();
    return std::all_of(numbers.begin(), numbers.end(), [&](Real x) { return x == numbers[0]; });
  }

  /// Returns whether the block's samples differ from the mean of their neighbours along i by `least` on
  /// average: only those count that have even coordinates and both neighbours.
  [[nodiscard]] bool is_noise(const SampleBlock<Real>& block, LatticePoint base, LatticePoint count,
                              double least) const {
    const std::int32_t first = base.i == 0 ? 1 : 0;
    const std::int32_t end = std::min((count.i + 1) / 2, (last_.i - base.i + 1) / 2);
    const std::int32_t all = (end - first) * count.j * count.k;
    if (end <= first || all < kLeastOfNoise) return false;
    double sum = 0;
    for (std::int32_t k = 0; k < count.k; ++k) {
      for (std::int32_t j = 0; j < count.j; ++j) {
        const Real* row = block.at({-1, j, k});  // odd coordinates, then even ones
        for (std::int32_t n = first; n < end; ++n)
          sum += std::abs(row[SampleBlock<Real>::kHalf + n] - (row[n] + row[n + 1]) / 2);
      }
    }
    return std::isfinite(sum) && sum >= least * all;
  }

  /// Returns a coordinate mirrored into the lattice: diamonds at its border have only half their tetrahedra,
  /// and the mirrored samples make others that are equal to these.
  [[nodiscard]] std::int32_t inside(std::int32_t x) const {
    return x < 0 ? -x : x > side_ ? 2 * side_ - x : x;
  }

  void load(const LodValues<Word>& lod, LatticePoint base, LatticePoint count, bool all_count,
            Work& work) const {
    for (std::int32_t k = -1; k <= count.k; ++k) {
      for (std::int32_t j = -1; j <= count.j; ++j) {
        const std::int32_t y = inside(base.j + j), z = inside(base.k + k);
        const Word* row = lod.samples(std::min(y, last_.j), std::min(z, last_.k));
        const LatticePoint first{-1, j, k};
        load_row(row, base.i, work.samples.at(first));
        if (!all_count)
          load_counted(work.samples.at(first), base.i, y <= last_.j && z <= last_.k ? last_.i : -1,
                       work.counted.at(first));
      }
    }
  }

  /// Loads the row's samples from -1 to 16, those with odd coordinates first.
  void load_row(const Word* row, std::int32_t base, Real* to) const {
    constexpr std::ptrdiff_t kHalf = SampleBlock<Real>::kHalf;
    if (base > 0 && base + 2 * kHalf - 2 <= last_.i) {
      const Word* from = row + base - 1;
      for (std::ptrdiff_t n = 0; n < kHalf; ++n) to[n] = real(from[2 * n]);
      for (std::ptrdiff_t n = 0; n < kHalf; ++n) to[kHalf + n] = real(from[2 * n + 1]);
      return;
    }
    for (std::int32_t n = 0; n < 2 * kHalf; ++n)
      to[n] = real(row[std::clamp(inside(coordinate(base, n)), 0, last_.i)]);
  }

  /// Loads the samples that interpolation is compared with; `last` is the last sample that counts.
  void load_counted(const Real* samples, std::int32_t base, std::int32_t last, Real* to) const {
    for (std::int32_t n = 0; n < 2 * SampleBlock<Real>::kHalf; ++n) {
      Real number = samples[n];
      if (inside(coordinate(base, n)) > last) {
        number = std::numeric_limits<Real>::quiet_NaN();
      } else if (std::is_same_v<Sample, float> && !std::isfinite(number)) {
        number = std::numeric_limits<Real>::infinity();
      }
      to[n] = number;
    }
  }

  /// Returns the coordinate of the nth number of a row of a block.
  static std::int32_t coordinate(std::int32_t base, std::int32_t n) {
    constexpr std::int32_t kHalf = SampleBlock<Real>::kHalf;
    return n < kHalf ? base + 2 * n - 1 : base + 2 * (n - kHalf);
  }
  static Real real(Word word) { return static_cast<Real>(from_ordered<Sample>(word)); }

  std::int32_t side_;
  LatticePoint last_;
  OwnErrorGeometry geometry_;
};

}  // namespace adamas::isosurface
