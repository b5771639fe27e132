#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/text.h"
#include "adamas/volume.h"

namespace adamas::io {

/// Parses numbers separated by blanks, as "1 2.5 -3"; empty if there is anything else.
template <class T>
std::optional<std::vector<T>> parse_number_list(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  std::vector<T> numbers;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    if (text.empty()) return numbers;
    const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
    T value{};
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (code != std::errc() || end != word.data() + word.size()) return {};
    numbers.push_back(value);
    text.remove_prefix(word.size());
  }
}

/// A unit as VolumeGrid may have it; empty for others.
inline std::string unit_of(std::string_view text) {
  std::string unit = visible_text(text);
  const bool kept = unit.size() <= VolumeGrid::kLongestUnit && unit.find('"') == std::string::npos;
  return kept ? unit : std::string();
}

/// The beginning of a file's text in a form for messages: one line of at most `most` characters.
inline std::string printable(std::string_view text, std::size_t most) {
  std::string result;
  for (const char c : text.substr(0, most)) result += c >= ' ' && c <= '~' ? c : '?';
  return result;
}

}  // namespace adamas::io
