#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

// The functions write files of formats byte by byte.

namespace adamas::test {

template <class T>
std::string bytes_of_values(const std::vector<T>& values, bool big_endian = false) {
  std::string bytes;
  for (const T& value : values) {
    std::string one(reinterpret_cast<const char*>(&value), sizeof(T));
    if (big_endian) std::reverse(one.begin(), one.end());
    bytes += one;
  }
  return bytes;
}

/// The NIfTI header of a volume of 3 x 2 x 2 samples, with the bytes before the samples in a single file.
class NiftiHeader {
 public:
  explicit NiftiHeader(bool big_endian = false) : big_(big_endian) {
    put<std::int32_t>(0, {348});
    put<std::int16_t>(40, {3, 3, 2, 2, 1, 1, 1, 1});
    put<std::int16_t>(70, {2, 8});
    put<float>(76, {1, 0.5f, 2, 3});
    put<float>(108, {352});
    magic("n+1");
  }
  template <class T>
  NiftiHeader& put(std::size_t at, const std::vector<T>& values) {
    const std::string bytes = bytes_of_values(values, big_);
    bytes_.replace(at, bytes.size(), bytes);
    return *this;
  }
  NiftiHeader& magic(const std::string& text) {
    bytes_.replace(344, text.size(), text);
    return *this;
  }
  NiftiHeader& type(std::int16_t code, std::size_t bytes) {
    return put<std::int16_t>(70, {code, static_cast<std::int16_t>(8 * bytes)});
  }
  [[nodiscard]] std::string text() const { return bytes_; }

 private:
  std::string bytes_ = std::string(352, '\0');
  bool big_;
};

/// Returns a TIFF of one page of 3 x 2 samples without compression, written byte by byte.
template <class T>
std::string tiff_of(const std::vector<T>& values, bool big) {
  const auto u16 = [big](unsigned v) {
    return bytes_of_values(std::vector<std::uint16_t>{static_cast<std::uint16_t>(v)}, big);
  };
  const auto u32 = [big](unsigned v) { return bytes_of_values(std::vector<std::uint32_t>{v}, big); };
  const std::string data = bytes_of_values(values, big);
  const unsigned format = std::is_floating_point_v<T> ? 3 : std::is_signed_v<T> ? 2 : 1;
  const std::vector<std::pair<unsigned, unsigned>> short_tags{
      {256, 3}, {257, 2}, {258, 8 * sizeof(T)}, {259, 1}, {262, 1}};
  std::string tags;
  unsigned count = 0;
  const auto add = [&](unsigned tag, bool wide, unsigned value) {
    tags += u16(tag) + u16(wide ? 4 : 3) + u32(1) + (wide ? u32(value) : u16(value) + u16(0));
    ++count;
  };
  for (const auto& [tag, value] : short_tags) add(tag, false, value);
  add(273, true, 8);
  add(277, false, 1);
  add(278, false, 2);
  add(279, true, static_cast<unsigned>(data.size()));
  add(339, false, format);
  return (big ? "MM" : "II") + u16(42) + u32(8 + static_cast<unsigned>(data.size())) + data + u16(count) +
         tags + u32(0);
}

}  // namespace adamas::test
