#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "isosurface/volume/page_grid.h"

namespace adamas::isosurface {

/// Which of the diamonds that a surface crosses are split, in an order in which parents come before their
/// children: those of greater error classes; of the same class those of earlier generations; of the same
/// generation those that come before a place of a page.
struct SurfaceCut {
  static constexpr int kAll = std::numeric_limits<int>::max();

  int error_class = 0;
  /// A diamond's generation is 3 for each LOD that it is finer than the root's, and its phase.
  int generation = kAll;
  std::uint64_t page = 0;  ///< the place in z-order of the page's cube among those of its LOD
  std::size_t place = 0;   ///< on that page

  /// The least class of a generation whose diamonds are all split.
  [[nodiscard]] int least_class(int of_generation) const {
    return of_generation < generation ? error_class : error_class + 1;
  }
};

/// The points of a page's row with odd and with even coordinates i, as bits.
inline constexpr std::uint16_t kOddPoints = 0xaaaa, kEvenPoints = 0x5555;

/// Which of the 16 codes of a row are not less than `least`, as bits. Codes are below 128, and
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

/// The phases of the diamonds of a page's row: of those with an odd coordinate i, and of those with an even
/// one; -1 where these points belong to coarser LODs.
struct RowPhases {
  int odd, even;

  RowPhases(std::int32_t j, std::int32_t k)
      : odd(2 - (j & 1) - (k & 1)), even((j | k) & 1 ? 3 - (j & 1) - (k & 1) : -1) {}
};

/// What a cut comes to on one page of an LOD: which of the page's diamonds it splits, by their error codes.
class CutOfPage {
 public:
  CutOfPage() = default;
  /// `generation`: of the LOD's diamonds of phase 0; `order`: the page's place in z-order.
  CutOfPage(const SurfaceCut& cut, int lod, int generation, std::uint64_t order) {
    for (int phase = 0; phase < 3; ++phase) {
      int least = cut.least_class(generation + phase);
      if (generation + phase == cut.generation && order < cut.page) least = cut.error_class;
      if (generation + phase == cut.generation && order == cut.page) {
        last_phase_ = phase;
        last_least_ = code(cut.error_class, lod);
        place_ = cut.place;
      }
      least_[static_cast<std::size_t>(phase)] = code(least, lod);
    }
  }

  bool operator==(const CutOfPage&) const = default;

  /// The least code of an LOD, but 0, whose class is not less; beyond all codes where there is none.
  static unsigned code(int error_class, int lod) {
    return static_cast<unsigned>(std::clamp(error_class - 4 * lod, 1, 128));
  }

  /// The least code that is split anywhere on the page.
  [[nodiscard]] unsigned least() const {
    const unsigned of_phases = *std::min_element(least_.begin(), least_.end());
    return last_phase_ < 0 ? of_phases : std::min(of_phases, last_least_);
  }

  /// The diamonds of a row that are split, as bits, by their codes.
  [[nodiscard]] unsigned split(const std::uint8_t* codes, const RowPhases& phases, std::size_t row) const {
    unsigned bits = row_not_less(codes, least_[static_cast<std::size_t>(phases.odd)]) & kOddPoints;
    if (phases.even >= 0)
      bits |= row_not_less(codes, least_[static_cast<std::size_t>(phases.even)]) & kEvenPoints;
    if (last_phase_ < 0) return bits;
    const unsigned of_phase =
        (phases.odd == last_phase_ ? kOddPoints : 0u) | (phases.even == last_phase_ ? kEvenPoints : 0u);
    constexpr int kSide = PageGrid::kSide;
    const auto before = static_cast<std::ptrdiff_t>(place_) - static_cast<std::ptrdiff_t>(kSide * row);
    const unsigned places = before <= 0 ? 0u : before >= kSide ? 0xffffu : (1u << before) - 1;
    return bits | (row_not_less(codes, last_least_) & of_phase & places);
  }

 private:
  std::array<unsigned, 3> least_{128, 128, 128};  ///< by phase: the least code that is split
  /// The phase whose diamonds before a place are split from another code on; -1 where the cut ends elsewhere.
  int last_phase_ = -1;
  unsigned last_least_ = 0;
  std::size_t place_ = 0;
};

}  // namespace adamas::isosurface
