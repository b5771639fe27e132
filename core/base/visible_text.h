#pragma once

#include <string>
#include <string_view>

namespace adamas {

/// Text of files and of names of files as a terminal may have it: control characters, bytes that are no UTF-8
/// and characters that turn the direction of writing or end a line appear as \x1b and \u202e, all else as it
/// is.
std::string visible_text(std::string_view text);

}  // namespace adamas
