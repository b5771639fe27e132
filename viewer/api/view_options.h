#pragma once

#include <array>

#include "adamas/view.h"
#include "viewer/session/view_session.h"

namespace adamas::viewer {

/// Whether pictures are drawn in a window or without one.
enum class ViewPlace : bool { kWindow, kOffscreen };

/// Throws Error (kUsage), which names options as on the command line, for values out of range and for options
/// that contradict each other.
void check_view_options(const ViewOptions& options);

/// The options for opening files.
DocumentOptions document_options(const ViewOptions& options, ViewPlace place);

/// The width and height of the pictures or of the window.
std::array<int, 2> picture_size(const ViewOptions& options, const std::array<int, 2>& otherwise);

/// Applies the options to the state of a session. Throws Error if no file has such a field or material.
void apply_view_options(const ViewOptions& options, ViewPlace place, ViewSession& view);

/// Restores the state that the options name, if there is one. Throws Error if it cannot be read.
void restore_state(const ViewOptions& options, ViewSession& view);

}  // namespace adamas::viewer
