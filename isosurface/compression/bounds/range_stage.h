#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "isosurface/compression/bounds/bounds_fields.h"
#include "isosurface/compression/bounds/bounds_stage.h"
#include "isosurface/compression/bounds/range_rounding.h"

namespace adamas::isosurface {

/// Codes the end of a range as a distance below the word `predicted`, in levels of a RangeRounding. The limit
/// is the least end that is expected, and not above `predicted`. All of them are rounded. A symbol stands for
/// one distance or several; extra bits distinguish these.
template <class Word>
struct RangeToken {
  static constexpr int kBits = 8 * sizeof(Word);
  static constexpr std::uint8_t kPredicted = 0;  ///< the end is the predicted word
  static constexpr std::uint8_t kLimit = 1;      ///< the end is the limit, which is another word
  static constexpr std::uint8_t kFirst = 2;      ///< the distance is 1
  /// Shorter distances have a symbol each, others one for each leading 1 and the bit below it.
  static constexpr int kDirectBits = 5;
  /// The first symbol with extra bits.
  static constexpr std::uint8_t kFirstOpen = kFirst + (1 << kDirectBits) - 1;
  /// The symbol of an end above the predicted word, or without a prediction; all bits of the end follow.
  static constexpr std::uint8_t kBehind = static_cast<std::uint8_t>(kFirstOpen + 2 * (kBits - kDirectBits));
  static constexpr std::size_t kSymbols = kBehind + 1;

  std::uint8_t symbol = 0;
  std::uint32_t extra = 0;

  /// Makes the token of an end. `bits` are those of the rounding.
  static constexpr RangeToken of(Word value, Word predicted, Word limit, int bits) {
    if (value == predicted) return {kPredicted, 0};
    if (value == limit) return {kLimit, 0};
    if (value > predicted || is_unknown(predicted)) return {kBehind, value};
    const auto distance = static_cast<std::uint32_t>((predicted >> bits) - (value >> bits));
    if (distance < 1u << kDirectBits) return {static_cast<std::uint8_t>(kFirst + distance - 1), 0};
    const auto width = static_cast<int>(std::bit_width(distance));
    const std::uint32_t half = distance >> (width - 2) & 1;
    return {static_cast<std::uint8_t>(kFirstOpen + 2 * (width - kDirectBits - 1) + static_cast<int>(half)),
            distance & ((1u << (width - 2)) - 1)};
  }

  /// Returns the number of extra bits of a symbol from kFirst on.
  static constexpr int extra_bits(std::uint8_t symbol) {
    if (symbol == kBehind) return kBits;
    return symbol < kFirstOpen ? 0 : (symbol - kFirstOpen) / 2 + kDirectBits - 1;
  }

  /// Returns the least distance of a symbol from kFirstOpen to before kBehind; its lowest bits are the extra
  /// ones.
  static constexpr std::uint32_t lead(std::uint8_t symbol) {
    const int number = symbol - kFirstOpen;
    return (2u | static_cast<std::uint32_t>(number & 1)) << (number / 2 + kDirectBits - 1);
  }

  static constexpr bool is_unknown(Word predicted) {
    return RangeRounding<Word>::kKeepsUnknown && predicted == RangeRounding<Word>::kUnknown;
  }
};

/// Predicts the ranges of a parity's points, each side alike (see BoundsFields). A range ends at `known`, the
/// least known word in and on the diamond, rounded, or below it; it does not end below its limit, which
/// follows from the ranges of the parents on the coarser LOD. The diamond of a centre is covered by those of
/// its faces, and that of a face by those of its edges: if all these are known, they determine the range.
template <class Word>
class RangeStages {
 public:
  static constexpr int kRoomClasses = 8, kErrorClasses = 8, kGroups = 3;
  /// The context of determined points, and of points whose limit is the predicted word: another range is
  /// possible only in a page that is of no volume.
  static constexpr std::uint8_t kDetermined = 0;
  static constexpr int kContexts = 1 + kGroups * kRoomClasses * kErrorClasses;

  /// Fills fields.known and fields.limits, and the stages of both sides with the points that are coded. All
  /// errors are known. `left_out`: whether determined points are not coded.
  static void make(BoundsFields<Word>& fields, const PageShape& shape, int parity, bool left_out,
                   std::array<BoundsStage, 2>& stages);
};

}  // namespace adamas::isosurface
