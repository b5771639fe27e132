#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace adamas::io {

/// The number at a place of a binary header, which must hold it whole.
template <class T>
T number_at(std::string_view bytes, std::size_t at, bool big_endian) {
  std::array<char, sizeof(T)> own;
  std::memcpy(own.data(), bytes.data() + at, sizeof(T));
  if (big_endian) std::reverse(own.begin(), own.end());
  return std::bit_cast<T>(own);
}

}  // namespace adamas::io
