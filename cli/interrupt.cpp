#include "cli/interrupt.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>

#include "core/base/abrupt_end.h"

namespace adamas {

namespace {

constexpr int kInterruptedStatus = 130;
constexpr std::array<int, 4> kStopping{SIGINT, SIGTERM, SIGHUP, SIGQUIT};

volatile std::sig_atomic_t flag = 0;

extern "C" void handle_signal(int) {
  const int before = errno;
  if (flag != 0) {
    clean_up_at_abrupt_end();
    _exit(kInterruptedStatus);
  }
  flag = 1;
  errno = before;
}

bool is_ignored(int number) {
  struct sigaction now {};
  return sigaction(number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

}  // namespace

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = handle_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  // Two signals at once must not both be the first.
  for (const int number : kStopping) sigaddset(&action.sa_mask, number);
  for (const int number : kStopping) {
    if (!is_ignored(number)) sigaction(number, &action, nullptr);
  }
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
  sigaction(SIGXFSZ, &ignore, nullptr);
}

bool interrupted() { return flag != 0; }

}  // namespace adamas
