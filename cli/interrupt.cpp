#include "cli/interrupt.h"

#include <csignal>

namespace adamas {

namespace {

volatile std::sig_atomic_t flag = 0;

extern "C" void set_interrupt_flag(int) { flag = 1; }

}  // namespace

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = set_interrupt_flag;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
  sigaction(SIGXFSZ, &ignore, nullptr);
}

bool interrupted() { return flag != 0; }

}  // namespace adamas
