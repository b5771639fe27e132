#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "isosurface/preprocessing/error_code.h"
#include "isosurface/preprocessing/lod_values.h"

namespace adamas::isosurface {

/// Whether a word of a float's (`ordered`) is that of a NaN or an infinity; integers are all finite.
template <class Word>
constexpr bool is_finite_word(Word word) {
  if constexpr (sizeof(Word) < 4) {
    return true;
  } else {
    return word > 0x007fffffu && word < 0xff800000u;
  }
}

/// Least and greatest sample in and on the tetrahedra of the smallest diamonds, those of phase 2 and scale 1:
/// the ends of the split edge and the nine points of the square across its middle. All other diamonds are
/// covered by such.
template <class Word>
class LeafRanges {
 public:
  /// The LOD of all samples; `last` of them.
  LeafRanges(LodValues<Word>& values, LatticePoint last)
      : values_(values), last_(last), is_flat_(last.i == 0 || last.j == 0 || last.k == 0) {}

  /// Fills in row (j, z); needs the samples of the planes next to it.
  void find(std::int32_t j, std::int32_t z) const {
    if (j % 2 == 1 && z % 2 == 1) return;
    const std::int32_t first = (j + z) % 2 == 0 ? 1 : 0;
    // Near the border points beyond the data are those of the data next to them, which the nine points have
    // too. Where a whole axis is but one sample this is not so.
    if (is_flat_) {
      for (std::int32_t i = first; i < values_.size().i; i += 2) find_flat({i, j, z});
    } else {
      find_row(j, z, first);
    }
  }

 private:
  void find_row(std::int32_t j, std::int32_t z, std::int32_t first) const {
    const int axis = first == 1 ? 0 : j % 2 == 1 ? 1 : 2;
    for (std::int32_t dz = -1; dz <= 1; ++dz) {
      for (std::int32_t dj = -1; dj <= 1; ++dj) {
        const bool is_across = axis == 0 || (axis == 1 ? dj == 0 : dz == 0);
        const bool is_along = axis == 1 ? dz == 0 : axis == 2 && dj == 0;
        if (!is_across && !is_along) continue;
        const Word* row = values_.samples(std::clamp(j + dj, 0, last_.j), std::clamp(z + dz, 0, last_.k));
        // Three samples of the row, or the one at i.
        const bool is_middle = axis == 0 ? dj == 0 && dz == 0 : is_across;
        if (is_middle) {
          widen<3>(row, j, z, first);
        } else {
          widen<1>(row, j, z, first);
        }
      }
    }
  }

  /// Takes Width samples round each point from a row.
  template <int Width>
  void widen(const Word* row, std::int32_t j, std::int32_t z, std::int32_t first) const {
    Word *low = values_.low(j, z), *high = values_.high(j, z);
    for (std::int32_t i = first; i <= last_.i; i += 2) {
      Word least = row[i], greatest = row[i];
      if constexpr (sizeof(Word) == 4) {
        if (!is_finite_word(row[i])) least = LodValues<Word>::kGreatest, greatest = 0;
      }
      if constexpr (Width == 3) {
        for (const std::int32_t at : {std::max(i - 1, 0), std::min(i + 1, last_.i)}) {
          if (!is_finite_word(row[at])) continue;
          least = std::min(least, row[at]);
          greatest = std::max(greatest, row[at]);
        }
      }
      low[i] = std::min(low[i], least);
      high[i] = std::max(high[i], greatest);
    }
  }

  void find_flat(LatticePoint p) const {
    Word &low = values_.low(p.j, p.k)[p.i], &high = values_.high(p.j, p.k)[p.i];
    for (int n = 0; n < 27; ++n) {
      const LatticePoint d = step_around(n);
      const LatticePoint q = p + d;
      int along = 0, across = 0;
      for (int axis = 0; axis < 3; ++axis) ((p[axis] & 1) != 0 ? along : across) += std::abs(d[axis]);
      if (along != 0 && across != 0) continue;
      if (std::min({q.i, q.j, q.k}) < 0 || q.i > last_.i || q.j > last_.j || q.k > last_.k) continue;
      const Word sample = values_.samples(q.j, q.k)[q.i];
      if (!is_finite_word(sample)) continue;
      low = std::min(low, sample);
      high = std::max(high, sample);
    }
  }

  LodValues<Word>& values_;
  LatticePoint last_;
  bool is_flat_;
};

/// Makes errors and ranges monotone, from the finest LOD up, plane by plane: a diamond takes what its
/// children have. With a point's coordinates in units of its LOD the children are its two neighbours along
/// each odd axis, but in phase 2, where there is one odd coordinate: there they are the eight points of the
/// next finer LOD round it.
template <class Word>
class LodSweep {
 public:
  /// `last`: sample of the volume.
  LodSweep(std::vector<LodValues<Word>>& lods, LatticePoint last)
      : lods_(lods), last_(last), next_(lods.size(), 0) {}

  /// All tetrahedra have been measured that touch the diamonds in planes of the LOD up to `measured`.
  /// Sweeps what can be swept, in this LOD alone; to be called from the finest one up.
  void advance(int lod, std::int32_t measured) {
    std::int32_t complete = measured;
    if (lod > 0 && done(lod - 1) < lods_[index(lod - 1)].size().k - 1)
      complete = std::min(complete, (done(lod - 1) - 1) >> 1);
    for (; next_[index(lod)] <= complete; ++next_[index(lod)]) {
      const std::int32_t z = next_[index(lod)];
      if (lod == 0) find_leaf_ranges(z);
      const bool is_end = z + 1 == lods_[index(lod)].size().k;
      if (z % 2 == 0) {
        sweep_plane(lod, z);
        if (z > 0) finish_odd_plane(lod, z - 1);
      } else if (is_end) {
        finish_odd_plane(lod, z);
      }
    }
  }

  /// The last plane whose points, and those of all planes before it, have their final values.
  [[nodiscard]] std::int32_t done(int lod) const {
    const std::int32_t next = next_[index(lod)];
    // An odd plane still needs the one behind it.
    return next % 2 == 1 || next == lods_[index(lod)].size().k ? next - 1 : next - 2;
  }

 private:
  using Values = LodValues<Word>;
  static std::size_t index(int lod) { return static_cast<std::size_t>(lod); }
  static constexpr std::size_t kGrain = 16;

  void find_leaf_ranges(std::int32_t z) {
    Values& values = lods_.front();
    const LeafRanges<Word> ranges(values, last_);
    parallel_for(static_cast<std::size_t>(values.size().j), kGrain,
                 [&](std::size_t j) { ranges.find(static_cast<std::int32_t>(j), z); });
  }

  void finish_odd_plane(int lod, std::int32_t z) {
    sweep_plane(lod, z);
    if (index(lod) + 1 == lods_.size()) return;
    Values& parents = lods_[index(lod) + 1];
    for (const std::int32_t parent : {(z - 1) / 2, (z + 1) / 2}) {
      if (parent >= parents.size().k) continue;
      parallel_for(static_cast<std::size_t>(parents.size().j), kGrain, [&](std::size_t j) {
        pull(lods_[index(lod)], parents, static_cast<std::int32_t>(j), parent, z);
      });
    }
  }

  /// Phase 1, and in odd planes phase 0 after it.
  void sweep_plane(int lod, std::int32_t z) {
    Values& values = lods_[index(lod)];
    for (const int odd_axes : {2, 3}) {
      parallel_for(static_cast<std::size_t>(values.size().j), kGrain, [&](std::size_t row) {
        const auto j = static_cast<std::int32_t>(row);
        const std::int32_t odd_i = odd_axes - j % 2 - z % 2;
        if (odd_i == 0 || odd_i == 1) take_neighbours(values, j, z, odd_i);
      });
    }
  }

  /// Points of the row whose first coordinate has this parity.
  static void take_neighbours(Values& values, std::int32_t j, std::int32_t z, std::int32_t odd_i) {
    const LatticePoint size = values.size();
    if (odd_i == 1) {
      take(values, j, z, 1, j, z, -1, size.i);
      take(values, j, z, 1, j, z, 1, size.i - 1);
    }
    if (j % 2 == 1) {
      take(values, j, z, odd_i, j - 1, z, 0, size.i);
      if (j + 1 < size.j) take(values, j, z, odd_i, j + 1, z, 0, size.i);
    }
    if (z % 2 == 1) {
      take(values, j, z, odd_i, j, z - 1, 0, size.i);
      if (z + 1 < size.k) take(values, j, z, odd_i, j, z + 1, 0, size.i);
    }
  }

  /// Takes from the points `shift` along another row.
  static void take(Values& values, std::int32_t j, std::int32_t z, std::int32_t first, std::int32_t from_j,
                   std::int32_t from_z, std::int32_t shift, std::int32_t end) {
    std::uint8_t* to = values.codes(j, z);
    const std::uint8_t* from = values.codes(from_j, from_z);
    for (std::int32_t i = first; i < end; i += 2) to[i] = std::max(to[i], from[i + shift]);
    Word *low = values.low(j, z), *high = values.high(j, z);
    const Word *from_low = values.low(from_j, from_z), *from_high = values.high(from_j, from_z);
    for (std::int32_t i = first; i < end; i += 2) {
      low[i] = std::min(low[i], from_low[i + shift]);
      high[i] = std::max(high[i], from_high[i + shift]);
    }
  }

  /// Phase 2 of row (j, z) of the coarser LOD, from the plane `fine_z` of the finer one.
  static void pull(Values& fine, Values& coarse, std::int32_t j, std::int32_t z, std::int32_t fine_z) {
    if (j % 2 == 1 && z % 2 == 1) return;
    const std::int32_t first = (j + z) % 2 == 0 ? 1 : 0;
    for (const std::int32_t fine_j : {2 * j - 1, 2 * j + 1}) {
      if (fine_j < 0 || fine_j >= fine.size().j) continue;
      for (const std::int32_t shift : {-1, 1})
        pull_row(fine, coarse, j, z, fine_j, fine_z, first == 0 && shift < 0 ? 2 : first, shift);
    }
  }

  static void pull_row(Values& fine, Values& coarse, std::int32_t j, std::int32_t z, std::int32_t fine_j,
                       std::int32_t fine_z, std::int32_t first, std::int32_t shift) {
    const std::int32_t end = std::min(coarse.size().i, (fine.size().i - 1 - shift) / 2 + 1);
    std::uint8_t* to = coarse.codes(j, z);
    const std::uint8_t* from = fine.codes(fine_j, fine_z);
    for (std::int32_t i = first; i < end; i += 2)
      to[i] = std::max(to[i], coarser_code(from[2 * i + shift], 1));
    Word *low = coarse.low(j, z), *high = coarse.high(j, z);
    const Word *from_low = fine.low(fine_j, fine_z), *from_high = fine.high(fine_j, fine_z);
    for (std::int32_t i = first; i < end; i += 2) {
      low[i] = std::min(low[i], from_low[2 * i + shift]);
      high[i] = std::max(high[i], from_high[2 * i + shift]);
    }
  }

  std::vector<Values>& lods_;
  LatticePoint last_;
  std::vector<std::int32_t> next_;
};

}  // namespace adamas::isosurface
