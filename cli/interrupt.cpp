#include "cli/interrupt.h"

#include <unistd.h>

#include <array>
#include <csignal>

namespace adamas {

namespace {

constexpr int kInterruptedStatus = 130;

volatile std::sig_atomic_t flag = 0;

/// Names of files in storage that a signal handler may read: it can neither allocate nor wait for a lock.
std::array<std::array<char, 4096>, 16> temporaries;
volatile std::sig_atomic_t temporary_count = 0;

extern "C" void handle_signal(int) {
  if (flag == 0) {
    flag = 1;
    return;
  }
  for (int i = 0; i < temporary_count; ++i) unlink(temporaries[static_cast<std::size_t>(i)].data());
  _exit(kInterruptedStatus);
}

}  // namespace

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = handle_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  // Two signals at once must not both be the first.
  sigaddset(&action.sa_mask, SIGINT);
  sigaddset(&action.sa_mask, SIGTERM);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
  sigaction(SIGXFSZ, &ignore, nullptr);
}

bool interrupted() { return flag != 0; }

void remove_at_abrupt_end(const std::string& path) {
  const auto index = static_cast<std::size_t>(temporary_count);
  if (index >= temporaries.size() || path.size() >= temporaries[index].size()) return;
  path.copy(temporaries[index].data(), path.size());
  temporary_count = temporary_count + 1;
}

}  // namespace adamas
