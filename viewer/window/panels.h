#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "viewer/session/view_session.h"
#include "viewer/window/window_input.h"

namespace adamas::viewer {

/// The figures of a frame of the window.
struct FrameTimes {
  double update_milliseconds = 0, draw_milliseconds = 0;
  std::uint64_t triangles = 0;
  double largest_error_pixels = 0;
};

/// The progress of an export, and the outcome of the last one.
struct ExportNotice {
  std::size_t done = 0, steps = 0;
  std::string outcome;  ///< shown until the user closes it
};

/// What the panels show besides the session, and what the user typed into them.
struct PanelState {
  std::string drawn_by;             ///< the graphics device
  std::vector<FrameTimes> history;  ///< the last frames, the newest last
  std::string path;                 ///< the path of a file to be opened
  std::string message;              ///< the outcome of the last action
  ExportNotice exporting;
  bool wants_open = false, wants_path_saved = false;

  void add(const FrameTimes& times);
};

/// Shows the panels, and changes the session as they are used. It has to be called between PanelContext's
/// begin() and end().
void show_panels(ViewSession& session, WindowInput& input, PanelState& panels);

/// The height of the panel of steps at the picture's lower edge: 0 if no series is open or panels are hidden.
float step_panel_height(const ViewSession& session);

}  // namespace adamas::viewer
