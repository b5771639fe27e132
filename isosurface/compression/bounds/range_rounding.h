#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "isosurface/volume/page.h"

namespace adamas::isosurface {

/// The rounding of the ends of stored ranges. Ends are rounded outwards to multiples of a power of two, as
/// words, but not beyond the ends of the whole volume's range. A surface stays the same, but the search for
/// it visits tetrahedra that it does not cross. Rounding keeps the order of ends, so a range stays inside
/// those that contain it.
///
/// Ends are given by side, as in BoundsFields: side 0 has least words; side 1 has the greatest ones with all
/// bits inverted.
template <class Word>
struct RangeRounding {
  /// The greatest number of bits: with fewer levels than 16, ranges would exclude little.
  static constexpr int kMostBits = 8 * sizeof(Word) - 4;
  /// An unknown end. No finite sample of four bytes has this word, and it stays as it is; shorter words are
  /// rounded as any other.
  static constexpr Word kUnknown = static_cast<Word>(~Word{0});
  static constexpr bool kKeepsUnknown = sizeof(Word) == 4;

  int bits = 0;                 ///< ends are multiples of 2^bits
  std::array<Word, 2> least{};  ///< the least end of the whole volume's range, by side

  [[nodiscard]] constexpr Word round(std::size_t side, Word end) const {
    if (kKeepsUnknown && end == kUnknown) return end;
    return from_level(side, static_cast<Word>(end >> bits));
  }
  /// Returns the end of a level, which is end >> bits; at least level(side).
  [[nodiscard]] constexpr Word from_level(std::size_t side, Word level) const {
    return std::max(static_cast<Word>(level << bits), least[side]);
  }
  /// Returns the least level.
  [[nodiscard]] constexpr Word level(std::size_t side) const {
    return static_cast<Word>(least[side] >> bits);
  }

  /// Rounds ranges. Empty ones stay as they are, and so do those of all words, which may stand for unknown
  /// ranges.
  template <class Ends>
  void round(Ends& low, Ends& high) const {
    if (bits == 0) return;
    for (std::size_t n = 0; n < low.size(); ++n) {
      if (low[n] > high[n] || (low[n] == 0 && high[n] == kUnknown)) continue;
      low[n] = round(0, low[n]);
      high[n] = static_cast<Word>(~round(1, static_cast<Word>(~high[n])));
    }
  }

  bool operator==(const RangeRounding&) const = default;
};

/// Returns the coarsest rounding that leaves 7 levels or more for the least ends or the greatest ends of
/// ranges like these, in any order. Levels of fewer than one end in a thousand do not count.
template <class Word>
RangeRounding<Word> find_rounding(std::vector<Word> low, std::vector<Word> high);

}  // namespace adamas::isosurface
