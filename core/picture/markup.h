#pragma once

#include <string>
#include <string_view>

namespace adamas::picture {

/// `text` in one line of valid UTF-8: control characters become spaces and broken bytes U+FFFD.
std::string one_line(std::string_view text);

/// Text for XML and HTML content and attributes: & < > " ' as references.
std::string escape_markup(std::string_view text);

/// Base64 (RFC 4648, with padding).
std::string base64(std::string_view bytes);

/// An SVG file of Cairo's with its ids (letters and a number) numbered anew in order of appearance: Cairo
/// counts through all files of a process, so that the same picture would differ from run to run.
std::string renumbered_svg(const std::string& svg);

}  // namespace adamas::picture
