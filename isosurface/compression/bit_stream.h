#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "core/base/assert.h"

namespace adamas {

/// A word as it lies in the stream: the least byte first.
[[nodiscard]] inline std::uint64_t little_endian(std::uint64_t word) {
  if constexpr (std::endian::native == std::endian::big) return __builtin_bswap64(word);
  return word;
}

/// Appends numbers of any few bits to a list of bytes, the least bit first.
class BitWriter {
 public:
  explicit BitWriter(std::vector<std::byte>& out) : out_(out) {}

  /// The `count` bits of value, which has no others; 0 <= count <= 63.
  void put(std::uint64_t value, int count) {
    ADAMAS_ASSERT(count >= 0 && count < 64 && value >> count == 0);
    word_ |= value << filled_;
    filled_ += count;
    if (filled_ < 64) return;
    append(8);
    filled_ -= 64;
    // What found no room.
    word_ = value >> (count - filled_);
  }

  /// Fills the last byte with zeros. Without it the bits of the last word are lost.
  void finish() {
    append(static_cast<std::size_t>(filled_ + 7) / 8);
    word_ = 0;
    filled_ = 0;
  }

 private:
  void append(std::size_t bytes) {
    const std::uint64_t word = little_endian(word_);
    const auto* begin = reinterpret_cast<const std::byte*>(&word);
    out_.insert(out_.end(), begin, begin + bytes);
  }

  std::vector<std::byte>& out_;
  std::uint64_t word_ = 0;
  int filled_ = 0;  ///< bits of word_ in use, below 64
};

/// Reads such a stream again. Reading past its end gives zeros and is seen afterwards, by `overrun()`: a loop
/// that is sure to end need not look at every number. Nothing outside the span is read.
class BitReader {
 public:
  static constexpr int kRefilled = 56;  ///< bits that are there after a refill

  explicit BitReader(std::span<const std::byte> bytes)
      : next_(bytes.data()), end_(bytes.data() + bytes.size()) {}

  /// Makes kRefilled bits or more available.
  void refill() {
    if (end_ - next_ < 8) return refill_at_end();
    std::uint64_t word = 0;
    std::memcpy(&word, next_, sizeof word);
    // Bits beyond the whole bytes come twice, with the same value.
    word_ |= little_endian(word) << filled_;
    next_ += (63 - filled_) >> 3;
    filled_ |= kRefilled;
  }

  /// The bits to come, the next one lowest. Those that no refill has made available have no meaning.
  [[nodiscard]] std::uint64_t window() const { return word_; }

  /// Passes over `count` bits, which are available.
  void skip(int count) {
    ADAMAS_ASSERT(count >= 0 && count <= filled_ && count < 64);
    word_ >>= count & 63;
    filled_ -= count;
  }

  /// The next `count` bits, which are available; count <= kRefilled.
  [[nodiscard]] std::uint64_t take(int count) {
    const std::uint64_t bits = word_ & ((std::uint64_t{1} << count) - 1);
    skip(count);
    return bits;
  }

  /// Whether more bits were taken than there are.
  [[nodiscard]] bool overrun() const { return filled_ < 8 * missing_; }

  /// Whether what is left is nothing but the zeros that fill the last byte.
  [[nodiscard]] bool at_end() const {
    const int left = filled_ - 8 * missing_;
    return next_ == end_ && left >= 0 && left < 8 && (word_ & ((1u << left) - 1)) == 0;
  }

 private:
  void refill_at_end() {
    for (; filled_ <= kRefilled; filled_ += 8) {
      if (next_ < end_) {
        word_ |= std::to_integer<std::uint64_t>(*next_++) << filled_;
      } else {
        // Held well below overflow, however many are asked for.
        missing_ = std::min(missing_ + 1, 1 << 20);
      }
    }
  }

  const std::byte* next_;
  const std::byte* end_;
  std::uint64_t word_ = 0;
  int filled_ = 0;   ///< available bits of word_
  int missing_ = 0;  ///< bytes that were asked for beyond the end
};

}  // namespace adamas
