#include "core/picture/markup.h"

#include <algorithm>
#include <cstdint>
#include <map>

#include "adamas/text.h"

namespace adamas::picture {
std::string one_line(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const auto first = static_cast<unsigned char>(text.front());
    if (length == 0) {
      result += "\xEF\xBF\xBD";
    } else if (length == 1 && (first < 0x20 || first == 0x7F)) {
      result += ' ';
    } else {
      result += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

std::string escape_markup(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  result.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = (word << 8) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    const std::size_t given = bytes.size() - i < 3 ? bytes.size() - i : 3;
    for (std::size_t k = 0; k < 4; ++k) result += k <= given ? kDigits[(word >> (18 - 6 * k)) & 63] : '=';
  }
  return result;
}

std::string renumbered_svg(const std::string& svg) {
  std::map<std::string, std::string, std::less<>> names;
  std::map<std::string, int, std::less<>> counts;
  std::string result;
  result.reserve(svg.size());
  std::size_t done = 0;
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::size_t at = 0; at < svg.size(); ++at) {
    const char c = svg[at];
    if (c != '"' && c != '#') continue;
    const bool definition = c == '"' && at >= 4 && svg.compare(at - 4, 4, " id=") == 0;
    if (!definition && c != '#') continue;
    std::size_t digits = at + 1;
    while (digits < svg.size() && is_letter(svg[digits])) ++digits;
    std::size_t end = digits;
    while (end < svg.size() && is_digit(svg[end])) ++end;
    if (digits == at + 1 || end == digits || end == svg.size() || (svg[end] != '"' && svg[end] != ')'))
      continue;
    const std::string name = svg.substr(at + 1, end - at - 1), stem = svg.substr(at + 1, digits - at - 1);
    std::string& replacement = names[name];
    if (replacement.empty()) replacement = stem + std::to_string(counts[stem]++);
    result.append(svg, done, at + 1 - done).append(replacement);
    done = end;
    at = end - 1;
  }
  return result.append(svg, done, std::string::npos);
}

}  // namespace adamas::picture
