#pragma once

#include <array>
#include <cstddef>
#include <cstring>

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

/// Copies every other number of a row of 16, from that at `first` (0 or 1) on, with the bits of `flipped`
/// inverted; the numbers between them stay.
template <class T>
void copy_every_other(const T* from, T* to, std::size_t first, T flipped) {
  using Lanes = RowLanes<T, 16>;
  using Part = typename Lanes::Part;
  constexpr T kAll = static_cast<T>(~T{0});
  std::array<T, Lanes::kStep> pattern;
  for (std::size_t n = 0; n < Lanes::kStep; ++n) pattern[n] = (n & 1) == first ? kAll : 0;
  const Part taken = Lanes::load(pattern.data());
  for (std::size_t n = 0; n < 16; n += Lanes::kStep) {
    const Part result = (taken & (Lanes::load(from + n) ^ flipped)) | (~taken & Lanes::load(to + n));
    std::memcpy(to + n, &result, Lanes::kPartBytes);
  }
}

}  // namespace adamas
