#pragma once

namespace adamas {

/// From here on SIGINT and SIGTERM only set a flag, and writing to a closed pipe or beyond the limit
/// of a file's size is an error instead of the end.
void catch_signals();

/// Whether one of them has come.
bool interrupted();

}  // namespace adamas
