#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "isosurface/compression/bounds/bounds_symbols.h"
#include "isosurface/compression/byte_stream.h"

namespace adamas::isosurface {

/// What the bytes of a page's bounds begin with: a byte of modes, errors lowest; the code of all errors where
/// that is their mode; the words of all ranges, by side, where that is theirs. Where something is coded, the
/// bytes of a RansEncoder follow, in which the bits that a stage's symbols leave open come after its escaped
/// symbols.
template <class Word>
struct BoundsHead {
  ErrorMode errors{};
  RangeMode ranges{};
  std::uint8_t error = 0;       ///< of all points, where errors are equal
  std::array<Word, 2> range{};  ///< of all points, by side, where ranges are equal

  void put(std::vector<std::byte>& bytes) const {
    ByteWriter out(bytes);
    out.number(
        static_cast<std::uint8_t>(static_cast<int>(errors) | static_cast<int>(ranges) << kRangeModeAt));
    if (errors == ErrorMode::kEqual) out.number(error);
    if (ranges != RangeMode::kEqual) return;
    for (const Word word : range) out.number(word);
  }

  static BoundsHead take(ByteReader& in) {
    BoundsHead head;
    const auto modes = in.number<std::uint8_t>();
    head.errors = static_cast<ErrorMode>(modes & ((1 << kRangeModeAt) - 1));
    head.ranges = static_cast<RangeMode>(modes >> kRangeModeAt);
    if (head.errors == ErrorMode::kEqual) head.error = in.number<std::uint8_t>();
    if (head.ranges != RangeMode::kEqual) return head;
    for (Word& word : head.range) word = in.number<Word>();
    return head;
  }

  /// Whether a page of this shape may begin so.
  [[nodiscard]] bool is_possible(const PageShape& shape, const RangeRounding<Word>& rounding) const {
    if (ranges > RangeMode::kEqual) return false;
    const bool any_point = shape.complete || shape.count != LatticePoint{1, 1, 1};
    if (errors == ErrorMode::kEqual &&
        (error == 0 || error >= BoundsContexts<Word>::kErrorSymbols || !any_point))
      return false;
    if (ranges != RangeMode::kEqual) return true;
    return any_point && rounding.round(0, range[0]) == range[0] && rounding.round(1, range[1]) == range[1];
  }

 private:
  static constexpr int kRangeModeAt = 2;
};

}  // namespace adamas::isosurface
