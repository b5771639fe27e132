#pragma once

#include <stdexcept>

namespace adamas {

/// Bad input: a file, an option or data that cannot be used. The message is one line that names the thing,
/// what was expected and what was found.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user asked to stop (Ctrl-C, a closed window).
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

}  // namespace adamas
