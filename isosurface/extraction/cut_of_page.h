#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "isosurface/extraction/surface_cut.h"
#include "isosurface/volume/page_grid.h"

namespace adamas {

/// Points of a row of a page with odd and with even coordinates i.
inline constexpr std::uint16_t kOddPoints = 0xaaaa, kEvenPoints = 0x5555;

/// Which of the 16 codes of a row are not less than `least`, as bits; codes are below 128, and
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

/// A row of points of a page that is no complete one, seen as phases of its diamonds: -1 where the points are
/// coarser ones.
struct RowPhases {
  int odd, even;  ///< of points with an odd coordinate i, and an even one

  RowPhases(std::int32_t j, std::int32_t k)
      : odd(2 - (j & 1) - (k & 1)), even((j | k) & 1 ? 3 - (j & 1) - (k & 1) : -1) {}
};

/// Of the diamonds of an LOD's page, those that a cut splits.
class CutOfPage {
 public:
  CutOfPage() = default;
  /// `order`: the page's in z-order; `generation`: that of the LOD's cubes.
  CutOfPage(const SurfaceCut& cut, int lod, int generation, std::uint64_t order) {
    for (int phase = 0; phase < 3; ++phase) {
      int rank = cut.least_rank(generation + phase);
      if (generation + phase == cut.generation && order < cut.page) rank = cut.rank;
      if (generation + phase == cut.generation && order == cut.page) {
        last_phase_ = phase;
        last_least_ = code(cut.rank, lod);
        place_ = cut.place;
      }
      least_[static_cast<std::size_t>(phase)] = code(rank, lod);
    }
  }

  bool operator==(const CutOfPage&) const = default;

  /// The least code of an LOD that has the rank; beyond all codes where none has.
  static unsigned code(int rank, int lod) {
    return static_cast<unsigned>(std::clamp(rank - 4 * lod, 1, 128));
  }

  /// No lesser code is split.
  [[nodiscard]] unsigned least() const {
    const unsigned of_phases = *std::min_element(least_.begin(), least_.end());
    return last_phase_ < 0 ? of_phases : std::min(of_phases, last_least_);
  }

  /// Of a row of codes, as bits.
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
  std::array<unsigned, 3> least_{128, 128, 128};  ///< by phase: codes that are split
  int last_phase_ = -1;  ///< where a phase's diamonds are split up to a place, from this code on
  unsigned last_least_ = 0;
  std::size_t place_ = 0;
};

}  // namespace adamas
