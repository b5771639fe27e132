#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "isosurface/preprocessing/lod_values.h"

namespace adamas {

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
      const LatticePoint d{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
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

}  // namespace adamas
