#pragma once

#include <signal.h>

#include <array>

namespace adamas::inline core {

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

}  // namespace adamas::inline core
