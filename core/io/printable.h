#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace adamas {

/// The beginning of what a file holds, for messages: one line of at most `most` characters.
inline std::string printable(std::string_view text, std::size_t most) {
  std::string result;
  for (const char c : text.substr(0, most)) result += c >= ' ' && c <= '~' ? c : '?';
  return result;
}

}  // namespace adamas
