#pragma once

#include <stdexcept>

namespace adamas::fuzz {

/// A law that holds whatever the bytes.
inline void require(bool law, const char* what) {
  if (!law) throw std::logic_error(what);
}

}  // namespace adamas::fuzz
