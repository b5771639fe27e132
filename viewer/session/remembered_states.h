#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "viewer/document/view_state.h"

namespace adamas::viewer {

/// Where a user's viewer keeps what it remembers: adamas/view.json in $XDG_STATE_HOME, or in ~/.local/state;
/// empty where there is no home.
std::filesystem::path remembered_states_file();

/// How files were looked at when they were last open together, in a file of states. What cannot be read is as
/// if it were not there.
std::optional<ViewState> remembered_state(const std::filesystem::path& file,
                                          const std::vector<std::string>& documents);

/// Keeps a state, and those of some fifty other sets of files. Throws Error where that cannot be written.
void remember_state(const std::filesystem::path& file, const std::vector<std::string>& documents,
                    const ViewState& state);

}  // namespace adamas::viewer
