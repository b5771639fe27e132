#pragma once

#include <filesystem>

namespace adamas {

/// From here on the first SIGINT or SIGTERM only sets a flag, the second ends the program at once, and
/// writing to a closed pipe or beyond the limit of a file's size is an error instead of the end.
void catch_signals();

/// Whether one of them has come.
bool interrupted();

/// A temporary file that a second signal removes, since no destructor will; with it what its writers have
/// beside it, which is called alike up to a number.
void remove_at_abrupt_end(const std::filesystem::path& temporary);
/// The same for a temporary folder and the files in it.
void remove_folder_at_abrupt_end(const std::filesystem::path& temporary);

}  // namespace adamas
