#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "viewer/session/view_session.h"

namespace adamas::viewer {

struct WindowOptions {
  int width = 1280, height = 800;
  std::filesystem::path pictures = ".";  ///< the folder for screenshots and recorded paths
  DocumentOptions documents;             ///< for files that are opened in the window
  /// Whether the window has to close; called at least twice a second.
  std::function<bool()> is_ended = [] { return false; };
};

/// Shows a session in a window until it is closed or ended. Throws Error if there is no display or no OpenGL
/// 4.5, or if the context is lost.
void show_window(ViewSession& session, const WindowOptions& options);

}  // namespace adamas::viewer
