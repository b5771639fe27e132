#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace adamas {

/// The context of an activity (InterpolationCells): its logarithm, in steps of half an octave, or of one
/// where the samples have 32 bits.
template <class Word>
struct ActivityContext {
  static constexpr bool kHalves = sizeof(Word) < 4;
  /// Activities are below 2^(bits + 4).
  static constexpr int kBits = 8 * static_cast<int>(sizeof(Word)) + 4;
  static constexpr int kContexts = 1 + (kHalves ? 2 : 1) * kBits;

  template <class Value>
  static constexpr std::uint8_t of(Value activity) {
    const auto bits = static_cast<std::uint64_t>(activity);
    const int width = std::bit_width(bits);
    if constexpr (!kHalves) return static_cast<std::uint8_t>(width);
    if (width < 2) return static_cast<std::uint8_t>(width);
    return static_cast<std::uint8_t>(2 * width - 1 + static_cast<int>(bits >> (width - 2) & 1));
  }
};

}  // namespace adamas
