#pragma once

#include <array>
#include <csignal>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

// This header has what a program that ends by signals needs of the library.

/// The signals that ask a program to end.
inline constexpr std::array<int, 4> kStoppingSignals{SIGINT, SIGTERM, SIGHUP, SIGQUIT};

/// Returns the stopping signals as a set for sigprocmask and the like.
inline sigset_t stopping_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : kStoppingSignals) sigaddset(&set, number);
  return set;
}

/// Returns whether this process ignores a signal; under nohup it ignores SIGHUP.
inline bool is_ignored(int number) {
  struct sigaction now {};
  return sigaction(number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

/// Makes later threads of parallel loops block these signals, so that the calling thread receives them. It is
/// called once, before anything else of the library.
void block_signals_in_workers(const sigset_t& signals);

/// Removes the temporary files and ends the processes of calls that have not returned, with nothing but calls
/// that a signal handler may make; it is for a handler that ends the program at once. In a forked child it
/// does nothing, since all of these are the parent's.
void clean_up_at_abrupt_end();

}  // namespace adamas
