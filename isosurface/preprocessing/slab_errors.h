#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "isosurface/preprocessing/coarse_errors.h"
#include "isosurface/preprocessing/cube_samples.h"
#include "isosurface/preprocessing/finest_errors.h"
#include "isosurface/preprocessing/lod_values.h"
#include "isosurface/preprocessing/octant_errors.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// Own errors of all diamonds, slab by slab of 16 cells along k.
template <class Sample>
class SlabErrors {
 public:
  using Word = OrderedWord<Sample>;
  using Lods = std::vector<LodValues<Word>>;

  /// `looks_for_noise`: whether diamonds in noise have the same bounds.
  SlabErrors(const PageGrid& grid, const Vec3& spacing, const CoarseSamples<Word>& coarse,
             bool looks_for_noise)
      : depth_(grid.depth()),
        looks_for_noise_(looks_for_noise),
        last_(grid.last()),
        finest_(depth_, last_, spacing),
        stencils_(depth_, spacing),
        small_(stencils_, spacing),
        large_(depth_, last_, spacing, coarse) {
    // Cubes that touch the data with one side alone count: they have tetrahedra of diamonds on that side.
    const std::int32_t cubes = std::max(1, (std::int32_t{1} << depth_) >> 4);
    for (int axis = 0; axis < 3; ++axis) cubes_[axis] = std::min(last_[axis] / 16 + 1, cubes);
  }

  [[nodiscard]] std::int32_t slabs() const { return cubes_.k; }

  /// Raises own codes by what slab `k` has; its samples are in LODs.front(), up to the plane 16 k + 16.
  void measure(std::int32_t k, Lods& lods) {
    measure_finest(k, lods.front());
    // Cubes that are worked on at the same time have no point in common.
    for (const LatticePoint first : {LatticePoint{0, 0, k}, {1, 0, k}, {0, 1, k}, {1, 1, k}}) {
      const auto columns = static_cast<std::size_t>((cubes_.i - first.i + 1) / 2);
      const auto rows = static_cast<std::size_t>((cubes_.j - first.j + 1) / 2);
      parallel_chunks(columns * rows, 4, [&](std::size_t begin, std::size_t end) {
        const auto work = std::make_unique_for_overwrite<Work>();
        for (std::size_t n = begin; n < end; ++n) {
          const auto i = static_cast<std::int32_t>(n % columns), j = static_cast<std::int32_t>(n / columns);
          measure_cube({16 * (first.i + 2 * i), 16 * (first.j + 2 * j), 16 * k}, lods, *work);
        }
      });
    }
  }

 private:
  struct Work {
    CubeSamples<Sample> samples;
    typename OctantErrors<Sample>::Codes codes;
  };

  /// Of scale 1: of the planes that begin with the slab, in the last slab those up to the end.
  void measure_finest(std::int32_t slab, LodValues<Word>& lod) {
    const auto blocks = [](std::int32_t size) { return static_cast<std::size_t>((size + 15) / 16); };
    const std::size_t columns = blocks(lod.size().i), rows = blocks(lod.size().j);
    const std::int32_t end = slab + 1 == slabs() ? lod.size().k : 16 * (slab + 1);
    const auto [low, high] = range_of(lod, 16 * slab);
    const double least_noise = looks_for_noise_ ? FinestErrors<Sample>::least_noise(low, high)
                                                : std::numeric_limits<double>::infinity();
    for (std::int32_t first = 16 * slab; first < end; first += 16) {
      std::vector<std::uint8_t> noise(columns * rows);
      const auto base = [columns, first](std::size_t n) {
        return LatticePoint{16 * static_cast<std::int32_t>(n % columns),
                            16 * static_cast<std::int32_t>(n / columns), first};
      };
      parallel_chunks(columns * rows, 4, [&](std::size_t begin, std::size_t chunk_end) {
        const auto work = std::make_unique_for_overwrite<typename FinestErrors<Sample>::Work>();
        for (std::size_t n = begin; n < chunk_end; ++n)
          noise[n] = finest_.measure(lod, base(n), least_noise, *work) ? 1 : 0;
      });
      if (std::find(noise.begin(), noise.end(), 1) != noise.end()) {
        // With one range for all noise up to here, diamonds between two blocks have it too.
        noise_low_ = std::min(noise_low_, low);
        noise_high_ = std::max(noise_high_, high);
        for (std::size_t n = 0; n < noise.size(); ++n) {
          if (noise[n] != 0) finest_.set_noise(lod, base(n), noise_low_, noise_high_);
        }
      }
      if (first == 16 * slab) noise_ = std::move(noise);
    }
    columns_ = columns;
  }

  /// Whether the block of the present slab is one of noise.
  [[nodiscard]] bool is_noise(LatticePoint base) const {
    return noise_[static_cast<std::size_t>(base.i >> 4) + columns_ * static_cast<std::size_t>(base.j >> 4)] !=
           0;
  }

  /// Of the finite samples in the planes from `first` to `first` + 15 and in those next to them.
  std::pair<Word, Word> range_of(const LodValues<Word>& lod, std::int32_t first) const {
    Word low = LodValues<Word>::kGreatest, high = 0;
    for (std::int32_t k = std::max(first - 1, 0); k <= std::min(first + 16, last_.k); ++k) {
      for (std::int32_t j = 0; j <= last_.j; ++j) {
        const Word* row = lod.samples(j, k);
        for (std::int32_t i = 0; i <= last_.i; ++i) {
          if (!is_finite_word(row[i])) continue;
          low = std::min(low, row[i]);
          high = std::max(high, row[i]);
        }
      }
    }
    return {low, high};
  }

  void measure_cube(LatticePoint base, Lods& lods, Work& work) const {
    work.samples.load(lods.front(), last_, base);
    if (depth_ > OctantStencils::kLeastBits && !work.samples.is_constant()) {
      if (is_noise(base)) {
        work.codes.fill(ErrorScale::kCodes - 1);
      } else {
        small_.measure(work.samples, work.codes);
      }
      for (int lod = OctantStencils::kLeastBits; lod < std::min(depth_, 3); ++lod)
        raise(lods[static_cast<std::size_t>(lod)], lod, base, work.codes.data());
    }
    if (depth_ > 3) large_.measure(work.samples, lods);
  }

  static void raise(LodValues<Word>& values, int lod, LatticePoint base, const std::uint8_t* codes) {
    constexpr std::int32_t kCube = OctantStencils::kCube;
    const LatticePoint size = values.size(), first{base.i >> lod, base.j >> lod, base.k >> lod};
    const std::int32_t side = 16 >> lod;
    for (std::int32_t k = 0; k <= std::min(side, size.k - 1 - first.k); ++k) {
      for (std::int32_t j = 0; j <= std::min(side, size.j - 1 - first.j); ++j) {
        std::uint8_t* row = values.codes(first.j + j, first.k + k) + first.i;
        const std::uint8_t* from = codes + kCube * ((j << lod) + kCube * (k << lod));
        const std::int32_t end = std::min(side, size.i - 1 - first.i);
        for (std::int32_t i = 0; i <= end; ++i) row[i] = std::max(row[i], from[i << lod]);
      }
    }
  }

  int depth_;
  bool looks_for_noise_;
  LatticePoint last_, cubes_{};
  FinestErrors<Sample> finest_;
  std::vector<std::uint8_t> noise_;  ///< of the slab's blocks, those along i first: whether they are noise
  std::size_t columns_ = 0;          ///< blocks along i
  /// Of samples where there is noise, in the slabs up to now.
  Word noise_low_ = LodValues<Word>::kGreatest, noise_high_ = 0;
  OctantStencils stencils_;
  OctantErrors<Sample> small_;
  CoarseErrors<Sample> large_;
};

}  // namespace adamas::isosurface
