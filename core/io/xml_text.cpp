#include "core/io/xml_text.h"

#include <cstddef>

namespace adamas {

namespace {

/// Length of the UTF-8 sequence that begins at `at`; 0 where there is none.
std::size_t utf8_length(const std::string& text, std::size_t at) {
  const auto byte = [&text](std::size_t i) {
    return static_cast<unsigned char>(i < text.size() ? text[i] : 0);
  };
  const unsigned first = byte(at), second = byte(at + 1);
  std::size_t length = 0;
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first < 0xe0) length = 2;
  if (first >= 0xe0 && first < 0xf0) length = 3;
  if (first >= 0xf0 && first < 0xf5) length = 4;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xc0u) != 0x80u) return 0;
  }
  // Overlong forms, surrogates and what lies beyond the last code point.
  const bool wrong = (first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
                     (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90);
  return wrong ? 0 : length;
}

std::string escaped(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\t':
    case '\n':
    case '\r':
      return "&#" + std::to_string(static_cast<int>(c)) + ";";
    default:
      return c >= 0 && c < ' ' ? "?" : std::string(1, c);
  }
}

}  // namespace

std::string xml_attribute(const std::string& name) {
  std::string result;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t length = utf8_length(name, at);
    if (length == 0) {
      const auto byte = static_cast<unsigned char>(name[at++]);
      result += static_cast<char>(0xc0u | (byte >> 6u));
      result += static_cast<char>(0x80u | (byte & 0x3fu));
    } else if (length == 1) {
      result += escaped(name[at++]);
    } else {
      result += name.substr(at, length);
      at += length;
    }
  }
  return result;
}

}  // namespace adamas
