#include "cli/interrupt.h"

#include <semaphore.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace adamas {

namespace {

constexpr int kInterruptedStatus = 130;

volatile std::sig_atomic_t flag = 0;
pid_t program = 0;
sem_t end_at_once;

std::mutex mutex;
std::vector<std::filesystem::path> temporaries;

extern "C" void handle_signal(int) {
  const int before = errno;
  if (flag == 0) {
    flag = 1;
  } else if (getpid() != program) {
    // A child that reads a file has no other threads, and no outputs.
    _exit(kInterruptedStatus);
  } else {
    sem_post(&end_at_once);
  }
  errno = before;
}

/// Removes the files beside a temporary one whose names begin as its own does before the number.
void remove_alike(const std::filesystem::path& temporary) {
  const std::string stem = temporary.stem().string();
  const std::string beginning = stem.substr(0, stem.rfind('-') + 1);
  std::error_code code;
  for (std::filesystem::directory_iterator at(temporary.parent_path(), code), end; !code && at != end;
       at.increment(code)) {
    std::error_code ignored;
    if (!beginning.empty() && at->path().filename().string().starts_with(beginning)) {
      std::filesystem::remove(at->path(), ignored);
    }
  }
}

/// Waits for the second signal in a thread of its own, for a handler may not look into folders.
void wait_for_end() {
  while (sem_wait(&end_at_once) != 0) continue;
  const std::lock_guard lock(mutex);
  for (const std::filesystem::path& temporary : temporaries) remove_alike(temporary);
  _exit(kInterruptedStatus);
}

}  // namespace

void catch_signals() {
  program = getpid();
  sem_init(&end_at_once, 0, 0);
  std::thread(wait_for_end).detach();
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

void remove_at_abrupt_end(const std::filesystem::path& temporary) {
  const std::lock_guard lock(mutex);
  temporaries.push_back(temporary);
}

}  // namespace adamas
