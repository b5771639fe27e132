#pragma once

#include <filesystem>
#include <string>

#include "viewer/scene/view_session.h"

namespace adamas {

struct WindowOptions {
  int width = 1280, height = 800;
  std::filesystem::path pictures = ".";  ///< the folder of screenshots and recorded paths
  DocumentOptions documents;             ///< of files that are opened in the window
};

/// Shows a session in a window, until that is closed. Throws Error where there is no display, no OpenGL 4.5,
/// or the context is lost.
void show_window(ViewSession& session, const WindowOptions& options);

}  // namespace adamas
