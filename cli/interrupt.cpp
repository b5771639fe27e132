#include "cli/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>

#include "adamas/stopping_signals.h"
#include "cli/exit_status.h"

namespace adamas::cli {

namespace {

std::atomic<bool> flag = false;
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void handle_signal(int) {
  const int before = errno;
  if (flag.exchange(true)) {
    clean_up_at_abrupt_end();
    _exit(kInterrupted);
  }
  errno = before;
}

}  // namespace

void catch_signals() {
  const sigset_t stopping = stopping_signals();
  struct sigaction action {};
  action.sa_handler = handle_signal;
  action.sa_flags = SA_RESTART;
  // Two signals that wait together are handled one after the other before the run goes on, and by one thread.
  action.sa_mask = stopping;
  block_signals_in_workers(stopping);
  for (const int number : kStoppingSignals) {
    if (!is_ignored(number)) sigaction(number, &action, nullptr);
  }
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
  sigaction(SIGXFSZ, &ignore, nullptr);
  pthread_sigmask(SIG_UNBLOCK, &stopping, nullptr);
}

bool interrupted() { return flag; }

}  // namespace adamas::cli
