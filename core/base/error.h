#pragma once

#include <fmt/format.h>

#include <utility>

#include "adamas/error.h"

namespace adamas::inline core {

/// Throws an Error with a formatted message.
template <class... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
  throw Error(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace adamas::inline core
