#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "isosurface/volume/page_grid.h"

namespace adamas::isosurface {

/// Identifies the diamonds that are split among those that a surface crosses, in an order in which parents
/// come before their children: those of greater error classes; of the same class those of earlier
/// generations; of the same generation those before a place of a page.
struct SurfaceCut {
  static constexpr int kAll = std::numeric_limits<int>::max();

  int error_class = 0;
  /// The generation of a diamond is 3 times the number of LODs that it is finer than the root, plus its
  /// phase.
  int generation = kAll;
  std::uint64_t page = 0;  ///< the place in z-order of the page's cube among those of its LOD
  std::size_t place = 0;   ///< the place on that page

  /// Returns the greatest class that a crossed diamond of an LOD which is not split may have; mostly one has
  /// just this class. `of_lod`: the generation of the LOD's diamonds of phase 0.
  [[nodiscard]] int greatest_left(int of_lod) const {
    return of_lod + 3 > generation ? error_class : error_class - 1;
  }
};

/// Returns the number of further error classes that may be split in one step, given the present number of
/// triangles and their limit: each class mostly multiplies the triangles by 2^(1/4).
inline int classes_further(double triangles, double most) {
  constexpr double kMost = 8;
  return static_cast<int>(std::clamp(4 * std::log2(most / std::max(triangles, 1.0)), 1.0, kMost));
}

/// The points of a page's row with odd and with even coordinates i, as bits.
inline constexpr std::uint16_t kOddPoints = 0xaaaa, kEvenPoints = 0x5555;

/// Returns those of the 16 codes of a row that are not less than `least`, as bits. Codes are below 128, and
/// 0 < least <= 128.
inline unsigned row_not_less(const std::uint8_t* codes, unsigned least) {
  constexpr std::uint64_t kOnes = 0x0101010101010101ull, kGather = 0x0002040810204081ull;
  const auto not_less = [least](const std::uint8_t* from) {
    std::uint64_t eight;
    std::memcpy(&eight, from, sizeof eight);
    const std::uint64_t high = (eight + kOnes * (128 - least)) & (kOnes << 7);
    return static_cast<unsigned>(high * kGather >> 56);
  };
  return not_less(codes) | not_less(codes + 8) << 8;
}

/// The phase of the diamonds of a page's row that have an odd coordinate i, and that of the diamonds with an
/// even one; -1 where these points belong to coarser LODs.
struct RowPhases {
  int odd, even;

  RowPhases(std::int32_t j, std::int32_t k)
      : odd(2 - (j & 1) - (k & 1)), even((j | k) & 1 ? 3 - (j & 1) - (k & 1) : -1) {}
};

/// Identifies the diamonds of a page that a cut splits among those of the cut's own error class.
class LastOfCut {
 public:
  LastOfCut() = default;
  /// Finds them. `generation`: that of the LOD's diamonds of phase 0; `order`: the page's place in z-order.
  LastOfCut(const SurfaceCut& cut, int generation, std::uint64_t order) {
    for (std::size_t phase = 0; phase < 3; ++phase) {
      const int own = generation + static_cast<int>(phase);
      if (own < cut.generation || (own == cut.generation && order < cut.page)) {
        ends_[phase] = PageGrid::kPoints;
      } else if (own == cut.generation && order == cut.page) {
        ends_[phase] = cut.place;
      }
    }
  }

  [[nodiscard]] bool has_none() const { return ends_ == std::array<std::size_t, 3>{}; }
  /// The place before which diamonds of a phase are split: 0 where none is, PageGrid::kPoints where all are.
  [[nodiscard]] std::size_t end(int phase) const { return ends_[static_cast<std::size_t>(phase)]; }
  /// The split diamonds of a row, as bits.
  [[nodiscard]] unsigned of_row(const RowPhases& phases, std::size_t row) const {
    constexpr int kSide = PageGrid::kSide;
    const auto of_phase = [&](int phase, unsigned points) {
      if (phase < 0) return 0u;
      const auto before = static_cast<std::ptrdiff_t>(end(phase)) - static_cast<std::ptrdiff_t>(kSide * row);
      return before <= 0 ? 0u : before >= kSide ? points : points & ((1u << before) - 1);
    };
    return of_phase(phases.odd, kOddPoints) | of_phase(phases.even, kEvenPoints);
  }

 private:
  std::array<std::size_t, 3> ends_{};  ///< by phase
};

/// A cut on one page of an LOD: it finds the diamonds of the page that are split from their error codes.
class CutOfPage {
 public:
  /// `generation` is that of the LOD's diamonds of phase 0, and `order` the page's place in z-order.
  CutOfPage(const SurfaceCut& cut, int lod, int generation, std::uint64_t order)
      : all_from_(code(cut.error_class + 1, lod)),
        last_from_(code(cut.error_class, lod)),
        last_(cut, generation, order) {
    // This makes cuts equal that split the same diamonds.
    if (last_.has_none()) last_from_ = all_from_;
  }

  /// The least code of an LOD, but 0, whose class is not less; beyond all codes where there is none.
  static unsigned code(int error_class, int lod) {
    return static_cast<unsigned>(std::clamp(error_class - 4 * lod, 1, 128));
  }

  /// Returns the least code that is split anywhere on the page.
  [[nodiscard]] unsigned least() const { return last_from_; }
  /// The place before which diamonds of a code and a phase are split: 0 where none is, PageGrid::kPoints
  /// where all are.
  [[nodiscard]] std::size_t end(unsigned code, int phase) const {
    return code >= all_from_ ? PageGrid::kPoints : code >= last_from_ ? last_.end(phase) : 0;
  }

 private:
  unsigned all_from_;   ///< diamonds of this code and of greater ones are all split
  unsigned last_from_;  ///< diamonds of codes from this one to that are split as last_ says
  LastOfCut last_;
};

}  // namespace adamas::isosurface
