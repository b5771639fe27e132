#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace adamas {

/// N numbers of a row, worked on together by the processor's instructions for 16 bytes: compilers unroll
/// loops of so few steps before they see that.
template <class T, std::size_t N>
class RowLanes {
 public:
  static constexpr std::size_t kPartBytes = N * sizeof(T) < 16 ? N * sizeof(T) : 16;
  static constexpr std::size_t kParts = N * sizeof(T) / kPartBytes;
  static constexpr std::size_t kStep = N / kParts;
  using Part [[gnu::vector_size(kPartBytes)]] = T;

  static Part load(const T* from) {
    Part part;
    std::memcpy(&part, from, kPartBytes);
    return part;
  }

  explicit RowLanes(const T* from) {
    for (std::size_t n = 0; n < kParts; ++n) parts_[n] = load(from + n * kStep);
  }
  void store(T* to) const {
    for (std::size_t n = 0; n < kParts; ++n) std::memcpy(to + n * kStep, &parts_[n], kPartBytes);
  }

  /// Keeps the lesser numbers.
  void take_least(const T* from) {
    for (std::size_t n = 0; n < kParts; ++n) {
      const Part other = load(from + n * kStep);
      parts_[n] = other < parts_[n] ? other : parts_[n];
    }
  }
  /// Keeps the greater ones.
  void take_greatest(const T* from) {
    for (std::size_t n = 0; n < kParts; ++n) {
      const Part other = load(from + n * kStep);
      parts_[n] = other > parts_[n] ? other : parts_[n];
    }
  }

 private:
  Part parts_[kParts];
};

/// All bits of every other number of a row of 16, from that at 0 or at 1 on.
template <class T>
inline constexpr auto kEveryOther = [] {
  std::array<std::array<T, 16>, 2> masks{};
  for (std::size_t n = 0; n < 16; ++n) masks[n & 1][n] = static_cast<T>(~T{0});
  return masks;
}();

/// The next wider unsigned integer.
template <class T>
using Wider = std::conditional_t<sizeof(T) == 1, std::uint16_t,
                                 std::conditional_t<sizeof(T) == 2, std::uint32_t, std::uint64_t>>;

/// Eight numbers, in parts of at most 16 bytes.
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
    const EightLanes taken = load(kEveryOther<T>[0].data());
    EightLanes lanes;
    for (std::size_t n = 0; n < kParts; ++n)
      lanes.parts[n] = (even.parts[n] & taken.parts[n]) | (odd.parts[n] & ~taken.parts[n]);
    return lanes;
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

/// Copies every other number of a row of 16, from that at `first` (0 or 1) on; the numbers between them stay.
template <class T>
void copy_every_other(const T* from, T* to, std::size_t first) {
  using Lanes = RowLanes<T, 16>;
  using Part = typename Lanes::Part;
  const Part taken = Lanes::load(kEveryOther<T>[first].data());
  for (std::size_t n = 0; n < 16; n += Lanes::kStep) {
    const Part result = (taken & Lanes::load(from + n)) | (~taken & Lanes::load(to + n));
    std::memcpy(to + n, &result, Lanes::kPartBytes);
  }
}

}  // namespace adamas
