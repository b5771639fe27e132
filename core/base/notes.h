#pragma once

#include <fmt/format.h>

#include <utility>

#include "adamas/progress.h"

namespace adamas::inline core {

/// Passes on a formatted remark.
template <class... Args>
void note(Progress& progress, fmt::format_string<Args...> format, Args&&... args) {
  progress.note(NoteKind::kRemark, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace adamas::inline core
