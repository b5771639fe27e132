#pragma once

namespace adamas::cli {

/// From here on the first SIGINT, SIGTERM, SIGHUP or SIGQUIT only sets a flag, and the second ends the
/// program at once, with what it would leave behind (core/base/abrupt_end.h). One that came before, while the
/// launcher had them blocked, counts. Those that whoever started the program has it ignore stay ignored.
/// Writing to a closed pipe or beyond the limit of a file's size is an error instead of the end.
void catch_signals();

/// Whether one of them has come.
bool interrupted();

}  // namespace adamas::cli
