#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// The kind of failure that an Error reports.
enum class ErrorKind : std::uint8_t {
  /// A file or data that cannot be used, or that do not have what an option names: a field, a material, a
  /// level, a place.
  kInput,
  /// An option that has no meaning here, a value that is not allowed, a step that a series does not have, or
  /// options that contradict each other.
  kUsage,
  kSpace,      ///< a file cannot be written in full, since the disk is full
  kDamaged,    ///< a file of this program that has changed since it was written
  kCancelled,  ///< the user asked to stop
};

/// A failure that the caller can do something about. The message is one line that names the file or the
/// option, what was expected and what was found. Options are named as on the command line
/// ("--interface-error").
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message, ErrorKind kind = ErrorKind::kInput)
      : std::runtime_error(message), kind_(kind) {}
  [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }

 private:
  ErrorKind kind_;
};

/// The user asked to stop (Ctrl-C, a closed window).
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled", ErrorKind::kCancelled) {}
};

}  // namespace adamas
