#pragma once

#include <cstddef>
#include <string>

#include "viewer/session/view_session.h"

namespace adamas::viewer {

/// How far an export is, and what came of the last one.
struct ExportNotice {
  std::size_t done = 0, steps = 0;
  std::string outcome;  ///< shown until it is put away
};

/// Shows that in a small window of its own at the upper edge, whether panels are put away or not. Between
/// PanelContext's begin() and end().
void show_export_panel(ViewSession& session, ExportNotice& notice);

}  // namespace adamas::viewer
