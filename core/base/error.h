#pragma once

#include <fmt/format.h>

#include <cerrno>
#include <utility>

#include "adamas/error.h"

namespace adamas::inline core {

/// Throws an Error with a formatted message.
template <class... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
  throw Error(fmt::format(format, std::forward<Args>(args)...));
}

/// Throws an Error of a certain kind with a formatted message.
template <class... Args>
[[noreturn]] void fail_as(ErrorKind kind, fmt::format_string<Args...> format, Args&&... args) {
  throw Error(fmt::format(format, std::forward<Args>(args)...), kind);
}

/// The kind of a failure to write, by the error number of the call that failed; 0 stands for a short write.
constexpr ErrorKind writing_failure(int number) {
  return number == 0 || number == ENOSPC || number == EDQUOT ? ErrorKind::kSpace : ErrorKind::kInput;
}

/// Throws an Error about options.
template <class... Args>
[[noreturn]] void wrong_usage(fmt::format_string<Args...> format, Args&&... args) {
  throw Error(fmt::format(format, std::forward<Args>(args)...), ErrorKind::kUsage);
}

}  // namespace adamas::inline core
