#pragma once

#include <string>
#include <string_view>

namespace adamas::picture {

/// The text in one line of valid UTF-8: control characters become spaces and broken bytes U+FFFD.
std::string one_line(std::string_view text);

/// The text for XML and HTML content and attributes, with & < > " ' as references.
std::string escape_markup(std::string_view text);

/// The bytes in Base64 (RFC 4648, with padding).
std::string base64(std::string_view bytes);

/// An SVG file of Cairo with its ids (letters and a number) renumbered in order of appearance: Cairo counts
/// them through all files of a process, so that the same picture would differ from run to run.
std::string renumbered_svg(const std::string& svg);

}  // namespace adamas::picture
