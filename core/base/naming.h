#pragma once

#include <string>
#include <string_view>

#include "core/base/error.h"

namespace adamas::inline core {

/// Calls `work` and returns its result. `name`, of a file or of other data, is put before the messages of its
/// errors, unless they begin with it already or are about options.
template <class Work>
auto naming(const std::string& name, Work&& work) {
  try {
    return work();
  } catch (const Error& e) {
    if (e.kind() == ErrorKind::kCancelled || e.kind() == ErrorKind::kUsage) throw;
    if (std::string_view(e.what()).starts_with(name)) throw;
    fail_as(e.kind(), "{}: {}", name, e.what());
  }
}

}  // namespace adamas::inline core
