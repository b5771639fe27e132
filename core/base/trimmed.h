#pragma once

#include <string_view>

namespace adamas {

/// A text without the blanks that it begins and ends with; `blanks` are what counts as such.
inline std::string_view trimmed(std::string_view text, std::string_view blanks = " \t\r") {
  const auto first = text.find_first_not_of(blanks), last = text.find_last_not_of(blanks);
  return first == std::string_view::npos ? std::string_view() : text.substr(first, last - first + 1);
}

}  // namespace adamas
