#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace adamas {

/// The context of an activity (InterpolationCells): its logarithm, in steps of half an octave, or of one
/// where the samples have 32 bits.
template <class Depth>
struct ActivityContext {
  static constexpr bool kHalves = Depth::kBits < 32;
  /// Activities are below 2^(bits + 4).
  static constexpr int kBits = Depth::kBits + 4;
  static constexpr int kContexts = 1 + (kHalves ? 2 : 1) * kBits;

  /// Of 16-bit numbers the highest bit, too, belongs to the activity.
  static constexpr std::uint8_t of(typename Depth::Value activity) {
    const auto number = static_cast<std::make_unsigned_t<typename Depth::Value>>(activity);
    if constexpr (kHalves) {
      // The exponent and the highest bit below the leading 1 of what a float holds exactly; 253 is before
      // that of 1. Without branches, so that a processor works at many at once.
      const auto upper =
          std::bit_cast<std::uint32_t>(static_cast<float>(static_cast<std::int32_t>(number))) >> 22;
      return static_cast<std::uint8_t>(std::max(static_cast<std::int32_t>(upper) - 253, 0));
    } else {
      return static_cast<std::uint8_t>(std::bit_width(number));
    }
  }
};

}  // namespace adamas
