#pragma once

namespace adamas::cli {

/// Makes the first SIGINT, SIGTERM, SIGHUP or SIGQUIT from now on only set a flag, and the second end the
/// program at once, after removing its temporary files (adamas/stopping_signals.h). A signal that came
/// before, while the launcher had it blocked, counts. Signals that the parent process made this one ignore
/// stay ignored. Writing to a closed pipe or beyond the limit of a file's size becomes an error instead of
/// the end.
void catch_signals();

/// Returns whether one of these signals has come.
bool interrupted();

}  // namespace adamas::cli
