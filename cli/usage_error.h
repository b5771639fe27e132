#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace adamas::cli {

/// The command line makes no sense: exit status 2 and a hint at --help.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws a UsageError with a formatted message of one line.
template <class... Args>
[[noreturn]] void wrong_usage(fmt::format_string<Args...> format, Args&&... args) {
  throw UsageError(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace adamas::cli
