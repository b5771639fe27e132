#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/export.h"
#include "adamas/geometry.h"

namespace adamas ADAMAS_API {

/// Returns a text without the blanks at its beginning and end; `blanks`: the characters that count as such.
inline std::string_view trimmed(std::string_view text, std::string_view blanks = " \t\r") {
  const auto first = text.find_first_not_of(blanks), last = text.find_last_not_of(blanks);
  return first == std::string_view::npos ? std::string_view() : text.substr(first, last - first + 1);
}

/// Returns the text with every `from` replaced by `to`, for example in messages about files with temporary
/// names.
std::string replaced(std::string text, const std::string& from, const std::string& to);

/// Joins the parts of a list for a sentence: "a", "a and b", "a, b and c". `last`: the word before the last
/// part.
std::string listed(const std::vector<std::string>& parts, const std::string& last = "and");

/// Returns the length in bytes of the UTF-8 character at the start of the text (RFC 3629: no overlong forms,
/// surrogates or code points beyond the last); 0 where there is none.
std::size_t utf8_length(std::string_view text);

/// Returns a text of a file, or its name, in a form that is safe to print on a terminal: control characters,
/// bytes that are no UTF-8, and characters that change the direction of writing or end a line become escapes,
/// as \x1b and \u202e.
std::string visible_text(std::string_view text);

/// Returns the finite number that the whole text stands for; none where it is no number.
std::optional<double> to_number(std::string_view text);

/// Returns the part before the unit of a text that ends in "voxels" or "cells", or their singular; none for
/// other texts.
std::optional<std::string> before_voxels(std::string_view text);

/// Returns "(x, y, z)", for a place or a direction in messages. No zero has a sign.
std::string place_text(const Vec3& p);
/// Returns "[0, 1] x [0, 1] x [0, 2]", for a box in messages.
std::string box_text(const Box3& box);

/// Returns a distance between interfaces with four digits; an infinite one is "none shown".
std::string length_text(double length);
/// Returns a number of bytes with a unit: "1.5 GiB".
std::string bytes_text(double bytes);
/// Returns a number with a noun: "1 site", "2 sites".
std::string counted(std::size_t count, const std::string& thing);
/// Returns a text as one word of a command line, in quotes where the shell would take it for something else.
std::string as_argument(const std::string& text);
/// Returns a cell of a table of comma-separated values: in quotes where it would be taken for several cells.
std::string csv_text(const std::string& text);

}  // namespace adamas
