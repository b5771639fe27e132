#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace adamas::isosurface {

static_assert(std::endian::native == std::endian::little, "files are little-endian, and read as they are");

/// Appends numbers to bytes, little-endian.
class ByteWriter {
 public:
  explicit ByteWriter(std::vector<std::byte>& out) : out_(out) {}

  template <class T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T>);
    bytes(std::as_bytes(std::span(&value, 1)));
  }
  /// Appends a number with seven bits a byte, the lowest first; the highest bit says that more follow.
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) out_.push_back(static_cast<std::byte>(value | 0x80));
    out_.push_back(static_cast<std::byte>(value));
  }
  void bytes(std::span<const std::byte> bytes) {
    const std::size_t at = out_.size();
    out_.resize(at + bytes.size());
    std::copy(bytes.begin(), bytes.end(), out_.begin() + static_cast<std::ptrdiff_t>(at));
  }
  /// Appends the number of the bytes and then the bytes.
  void sized_bytes(std::span<const std::byte> all) {
    varint(all.size());
    bytes(all);
  }

 private:
  std::vector<std::byte>& out_;
};

/// Takes numbers from the front of bytes. After a read beyond the end, all numbers are 0 and good() is false.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] std::span<const std::byte> rest() const { return rest_; }

  template <class T>
  T number() {
    static_assert(std::is_arithmetic_v<T>);
    T value{};
    const std::span<const std::byte> from = bytes(sizeof(T));
    if (!from.empty()) std::memcpy(&value, from.data(), sizeof(T));
    return value;
  }
  /// Takes a number of ByteWriter::varint(); longer encodings of the number are refused.
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const auto byte = number<std::uint8_t>();
      const std::uint64_t part = byte & 0x7fu;
      if (shift == 63 && part > 1) break;
      value |= part << shift;
      if ((byte & 0x80u) != 0) continue;
      if (part == 0 && shift > 0) break;
      return good_ ? value : 0;
    }
    fail();
    return 0;
  }
  /// Takes `size` bytes; the result is empty where there are fewer.
  std::span<const std::byte> bytes(std::uint64_t size) {
    if (size > rest_.size()) {
      fail();
      return {};
    }
    const auto taken = rest_.first(static_cast<std::size_t>(size));
    rest_ = rest_.subspan(static_cast<std::size_t>(size));
    return taken;
  }
  std::span<const std::byte> sized_bytes() { return bytes(varint()); }

 private:
  void fail() {
    good_ = false;
    rest_ = {};
  }

  std::span<const std::byte> rest_;
  bool good_ = true;
};

}  // namespace adamas::isosurface
