#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "viewer/contents/view_state.h"

namespace adamas::viewer {

/// The file in which a user's viewer keeps states: adamas/view.json in $XDG_STATE_HOME, or in ~/.local/state;
/// empty if there is no home.
std::filesystem::path remembered_states_file();

/// The state in which files were last shown together, from a file of states. Empty if there is none, or if it
/// cannot be read.
std::optional<ViewState> remembered_state(const std::filesystem::path& file,
                                          const std::vector<std::string>& documents);

/// Saves the state of these files in a file of states, beside those of some fifty other sets of files. Throws
/// Error if that cannot be written.
void remember_state(const std::filesystem::path& file, const std::vector<std::string>& documents,
                    const ViewState& state);

}  // namespace adamas::viewer
