#pragma once

#include <array>
#include <utility>

namespace adamas::cli {

/// The exit status of the program.
enum ExitStatus { kDone = 0, kFailed = 1, kWrongUsage = 2, kIncomplete = 3, kInterrupted = 130 };

inline constexpr std::array<std::pair<int, const char*>, 5> kExitStatuses{{
    {kDone, "Done."},
    {kFailed, "Failed, with one line that names the file, what was expected and what was found."},
    {kWrongUsage, "Wrong usage."},
    {kIncomplete,
     "Done, but an error that was wanted was not reached, or the result is coarser or incomplete in places, "
     "since a stored volume or a step is damaged."},
    {kInterrupted, "Stopped by a signal."},
}};

}  // namespace adamas::cli
