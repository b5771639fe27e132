#pragma once

#include <stdexcept>

namespace adamas::fuzz {

/// Requires a law that holds for any bytes.
inline void require(bool law, const char* what) {
  if (!law) throw std::logic_error(what);
}

}  // namespace adamas::fuzz
