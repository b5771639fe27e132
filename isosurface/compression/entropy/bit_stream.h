#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "core/base/assert.h"

namespace adamas::isosurface {

/// Returns a word in the byte order of the stream, the lowest byte first.
[[nodiscard]] inline std::uint64_t little_endian(std::uint64_t word) {
  if constexpr (std::endian::native == std::endian::big) return __builtin_bswap64(word);
  return word;
}

/// Appends numbers of any few bits to a list of bytes, the least bit first.
class BitWriter {
 public:
  explicit BitWriter(std::vector<std::byte>& out) : out_(out) {}

  /// Appends the `count` bits of value, which has no others; 0 <= count <= 63.
  void put(std::uint64_t value, int count) {
    ADAMAS_ASSERT(count >= 0 && count < 64 && value >> count == 0);
    word_ |= value << filled_;
    filled_ += count;
    if (filled_ < 64) return;
    append(8);
    filled_ -= 64;
    // These bits did not fit.
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

/// Reads the stream of a BitWriter. Bits beyond its end are zeros, and `overrun()` tells of them afterwards:
/// a loop that is sure to end need not check each number. Nothing outside the span is read.
class BitReader {
 public:
  static constexpr int kRefilled = 56;  ///< available bits after a refill

  explicit BitReader(std::span<const std::byte> bytes)
      : next_(bytes.data()), end_(bytes.data() + bytes.size()) {}

  /// Makes kRefilled bits or more available.
  void refill() {
    if (end_ - next_ < 8) return refill_at_end();
    std::uint64_t word = 0;
    std::memcpy(&word, next_, sizeof word);
    // Bits beyond the whole bytes are added twice, with the same value.
    word_ |= little_endian(word) << filled_;
    next_ += (63 - filled_) >> 3;
    filled_ |= kRefilled;
  }

  /// Returns the next bits, the first one lowest. Only available bits have a meaning.
  [[nodiscard]] std::uint64_t window() const { return word_; }

  /// Skips `count` bits, which are available.
  void skip(int count) {
    ADAMAS_ASSERT(count >= 0 && count <= filled_ && count < 64);
    word_ >>= count & 63;
    filled_ -= count;
  }

  /// Takes the next `count` bits, which are available; count <= kRefilled.
  [[nodiscard]] std::uint64_t take(int count) {
    const std::uint64_t bits = word_ & ((std::uint64_t{1} << count) - 1);
    skip(count);
    return bits;
  }

  /// Returns whether more bits were taken than there are.
  [[nodiscard]] bool overrun() const { return filled_ < 8 * missing_; }

  /// Returns whether only the zeros that fill the last byte are left.
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
        // The number is kept well below overflow.
        missing_ = std::min(missing_ + 1, 1 << 20);
      }
    }
  }

  const std::byte* next_;
  const std::byte* end_;
  std::uint64_t word_ = 0;
  int filled_ = 0;   ///< available bits of word_
  int missing_ = 0;  ///< bytes beyond the end that were read
};

/// Reads bits from the front of bytes in memory that are followed by kSlack readable zeros. Bits beyond the
/// end are zeros; the number of bits that were taken tells whether there were any.
class BitCursor {
 public:
  static constexpr std::size_t kSlack = 8;
  static constexpr int kMost = 57;  ///< greatest number of bits that can be taken at once

  BitCursor(const std::byte* begin, std::size_t size) : begin_(begin), size_(size) {}

  [[nodiscard]] std::uint64_t take(int count) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, next(), sizeof bits);
    bits = little_endian(bits) >> taken_ % 8 & ((std::uint64_t{1} << count) - 1);
    taken_ += static_cast<std::size_t>(count);
    return bits;
  }
  void skip(std::size_t count) { taken_ += count; }

  [[nodiscard]] std::size_t taken() const { return taken_; }
  /// Returns the byte of the next bit, or the zeros after the end. left() is the number of bytes from there
  /// to the end.
  [[nodiscard]] const std::byte* next() const { return begin_ + std::min(taken_ / 8, size_); }
  [[nodiscard]] std::size_t left() const { return size_ - std::min(taken_ / 8, size_); }

  /// Returns the end of the bytes of which bits were taken; null unless all remaining bits there are zeros.
  [[nodiscard]] const std::byte* end() const {
    const std::size_t bytes = (taken_ + 7) / 8;
    if (bytes > size_) return nullptr;
    if (taken_ % 8 != 0 && std::to_integer<unsigned>(begin_[bytes - 1]) >> taken_ % 8 != 0) return nullptr;
    return begin_ + bytes;
  }

 private:
  const std::byte* begin_;
  std::size_t size_;
  std::size_t taken_ = 0;
};

// The functions below write and read Elias codes of numbers from 1 on (P. Elias, "Universal codeword sets and
// representations of the integers", IEEE Trans. Inf. Theory 21(2), 1975).

/// Writes the gamma code of a number from 1 to 2^16 - 1, which has twice as many bits as the number, less
/// one.
inline void put_gamma(BitWriter& out, std::uint32_t value) {
  const auto bits = static_cast<int>(std::bit_width(value));
  out.put(1u << (bits - 1), bits);
  out.put(value & ((1u << (bits - 1)) - 1), bits - 1);
}

/// Reads a gamma code; 0 where the bits are not one.
inline std::uint32_t take_gamma(BitReader& in) {
  in.refill();
  const int bits = std::countr_zero(in.window() | 1u << 16) + 1;
  if (bits > 16) return 0;
  in.skip(bits);
  return 1u << (bits - 1) | static_cast<std::uint32_t>(in.take(bits - 1));
}

/// The delta code of a number below 2^kMostDeltaBits is a gamma code of the number of bits, then all bits but
/// the first.
inline constexpr int kMostDeltaBits = 56;

inline void put_delta(BitWriter& out, std::uint64_t value) {
  const auto bits = static_cast<int>(std::bit_width(value));
  put_gamma(out, static_cast<std::uint32_t>(bits));
  out.put(value & ((std::uint64_t{1} << (bits - 1)) - 1), bits - 1);
}

/// Reads a delta code; 0 where the bits are not one.
inline std::uint64_t take_delta(BitReader& in) {
  const std::uint32_t bits = take_gamma(in);
  if (bits == 0 || bits > kMostDeltaBits) return 0;
  in.refill();
  return std::uint64_t{1} << (bits - 1) | in.take(static_cast<int>(bits) - 1);
}

}  // namespace adamas::isosurface
