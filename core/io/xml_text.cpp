#include "core/io/xml_text.h"

#include <cstddef>
#include <string_view>

#include "core/base/text.h"

namespace adamas {

namespace {

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
    const std::size_t length = utf8_length(std::string_view(name).substr(at));
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
