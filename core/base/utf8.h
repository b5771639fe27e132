#pragma once

#include <cstddef>
#include <string_view>

namespace adamas {

/// Length in bytes of the character of UTF-8 at the start of the text (RFC 3629: no overlong forms,
/// surrogates or code points beyond the last); 0 where there is none.
std::size_t utf8_length(std::string_view text);

}  // namespace adamas
