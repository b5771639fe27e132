#pragma once

#include <array>
#include <csignal>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

// What a program that ends by signals needs of the library.

/// The signals that ask a program to end.
inline constexpr std::array<int, 4> kStoppingSignals{SIGINT, SIGTERM, SIGHUP, SIGQUIT};

/// The stopping signals as a set for sigprocmask and the like.
inline sigset_t stopping_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : kStoppingSignals) sigaddset(&set, number);
  return set;
}

/// Whether this process ignores a signal; under nohup it ignores SIGHUP.
inline bool is_ignored(int number) {
  struct sigaction now {};
  return sigaction(number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

/// Has later threads of parallel loops leave signals to the thread that calls this. To be called once, before
/// anything else of the library.
void block_signals_in_workers(const sigset_t& signals);

/// Removes the temporary files and ends the processes of calls that have not returned, with nothing but calls
/// that a signal handler may make: for a handler that ends the program at once. In a child that was forked it
/// does nothing, since all of them are the parent's.
void clean_up_at_abrupt_end();

}  // namespace adamas
