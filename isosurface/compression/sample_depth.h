#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

namespace adamas {

/// How samples are computed with when they are predicted: those from 0 to kGreatest, kCentre less, as numbers
/// that are wide enough for sums of a few of them.
template <class SampleWord, class Number, int kSampleBits, SampleWord kGreatestSample, SampleWord kMiddle>
struct SampleDepth {
  using Word = SampleWord;
  using Value = Number;
  static constexpr int kBits = kSampleBits;
  static constexpr Word kGreatest = kGreatestSample, kCentre = kMiddle;

  static constexpr Value value(Word word) { return static_cast<Value>(static_cast<Word>(word - kCentre)); }
  static constexpr Word word(Value value) { return static_cast<Word>(static_cast<Word>(value) + kCentre); }
};

template <class Word, class Value>
using WholeDepth =
    SampleDepth<Word, Value, std::numeric_limits<Word>::digits, std::numeric_limits<Word>::max(), 0>;

using Depth8 = WholeDepth<std::uint8_t, std::int16_t>;
using Depth16 = WholeDepth<std::uint16_t, std::int32_t>;
using Depth32 = WholeDepth<std::uint32_t, std::int64_t>;
/// So many that sums of twelve, and of eight halves besides, fit in 16 bits. Others are coded too, badly.
using Depth12 = SampleDepth<std::uint16_t, std::int16_t, 12, 4094, 2047>;

/// That of all samples of a type.
template <class Word>
using DepthOf =
    std::conditional_t<sizeof(Word) == 1, Depth8, std::conditional_t<sizeof(Word) == 2, Depth16, Depth32>>;

}  // namespace adamas
