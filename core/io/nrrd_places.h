#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/nrrd_header.h"

namespace adamas::io {

/// A word of a header as a number, if it is one.
template <class T>
std::optional<T> nrrd_number(std::string_view word) {
  T value{};
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

/// The fields of an NRRD header that have an entry for each axis, as words of its text.
struct NrrdPlaces {
  using Words = std::vector<std::string_view>;

  std::size_t dimension = 0;  ///< 0: not given
  std::vector<std::size_t> sizes;
  Words spacings, mins, maxs, centers, kinds, origin;
  std::vector<Words> directions;

  /// Sets what they say of sizes, components, axes and centers. Throws Error with `name` where that is no
  /// grid in space.
  void apply(const std::string& name, NrrdHeader& header) const;

 private:
  enum class Other { kNone, kFirst, kLast };
  /// Whether the first or the last axis is none of space, but one of components.
  [[nodiscard]] Other other_axis(const std::string& name) const;
  /// Whether the header says that of an axis.
  [[nodiscard]] bool is_other(std::size_t at) const;
  void set_axis(std::size_t axis, std::size_t at, NrrdHeader& header) const;
  [[nodiscard]] Vec3 direction(const std::string& name, std::size_t at) const;
};

}  // namespace adamas::io
