#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace adamas {

/// All bits of every other of eight numbers.
template <class T>
inline constexpr auto kEveryOther = [] {
  std::array<T, 8> mask{};
  for (std::size_t n = 0; n < mask.size(); n += 2) mask[n] = static_cast<T>(~T{0});
  return mask;
}();

/// The next wider unsigned integer.
template <class T>
using Wider = std::conditional_t<sizeof(T) == 1, std::uint16_t,
                                 std::conditional_t<sizeof(T) == 2, std::uint32_t, std::uint64_t>>;

/// Eight numbers of a row, worked on together by the processor's instructions for 16 bytes at most: compilers
/// unroll loops of so few steps before they see that.
template <class T>
struct EightLanes {
  static constexpr std::size_t kPartBytes = 8 * sizeof(T) < 16 ? 8 * sizeof(T) : 16;
  static constexpr std::size_t kStep = kPartBytes / sizeof(T), kParts = 8 / kStep;
  using Part [[gnu::vector_size(kPartBytes)]] = T;
  Part parts[kParts];

  static EightLanes load(const T* from) {
    EightLanes lanes;
    std::memcpy(lanes.parts, from, sizeof lanes.parts);
    return lanes;
  }
  void store(T* to) const { std::memcpy(to, parts, sizeof parts); }

  static EightLanes least(const EightLanes& a, const EightLanes& b) {
    EightLanes lanes;
    for (std::size_t n = 0; n < kParts; ++n)
      lanes.parts[n] = b.parts[n] < a.parts[n] ? b.parts[n] : a.parts[n];
    return lanes;
  }
  static EightLanes greatest(const EightLanes& a, const EightLanes& b) {
    EightLanes lanes;
    for (std::size_t n = 0; n < kParts; ++n)
      lanes.parts[n] = b.parts[n] > a.parts[n] ? b.parts[n] : a.parts[n];
    return lanes;
  }
  [[nodiscard]] EightLanes inverted() const {
    EightLanes lanes;
    for (std::size_t n = 0; n < kParts; ++n) lanes.parts[n] = ~parts[n];
    return lanes;
  }
  /// Of each lane with an even number that of the first, of the others that of the second.
  static EightLanes by_turns(const EightLanes& even, const EightLanes& odd) {
    const EightLanes taken = load(kEveryOther<T>.data());
    EightLanes lanes;
    for (std::size_t n = 0; n < kParts; ++n)
      lanes.parts[n] = (even.parts[n] & taken.parts[n]) | (odd.parts[n] & ~taken.parts[n]);
    return lanes;
  }
  /// Reads 16 numbers, each in turn into one of them: the inverse.
  static void load_by_turns(const T* from, EightLanes& even, EightLanes& odd) {
    using Pairs [[gnu::vector_size(2 * kPartBytes)]] = Wider<T>;
    constexpr bool kLittle = std::endian::native == std::endian::little;
    EightLanes &low = kLittle ? even : odd, &high = kLittle ? odd : even;
    for (std::size_t n = 0; n < kParts; ++n) {
      Pairs pairs;
      std::memcpy(&pairs, from + 2 * kStep * n, sizeof pairs);
      low.parts[n] = __builtin_convertvector(pairs & static_cast<Wider<T>>(static_cast<T>(~T{0})), Part);
      high.parts[n] = __builtin_convertvector(pairs >> 8 * sizeof(T), Part);
    }
  }
  /// Writes 16 numbers, one of each in turn.
  static void store_by_turns(const EightLanes& even, const EightLanes& odd, T* to) {
    using Pairs [[gnu::vector_size(2 * kPartBytes)]] = Wider<T>;
    constexpr bool kLittle = std::endian::native == std::endian::little;
    const EightLanes &low = kLittle ? even : odd, &high = kLittle ? odd : even;
    for (std::size_t n = 0; n < kParts; ++n) {
      const Pairs pairs = __builtin_convertvector(low.parts[n], Pairs) |
                          __builtin_convertvector(high.parts[n], Pairs) << 8 * sizeof(T);
      std::memcpy(to + 2 * kStep * n, &pairs, sizeof pairs);
    }
  }
};

}  // namespace adamas
