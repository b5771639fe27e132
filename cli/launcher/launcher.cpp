// This is the program that users start as `adamas`. The dynamic loader takes some 20 ms for the libraries of
// the main program, and a signal that comes meanwhile would end it without a message. So this program, which
// needs no library, blocks the signals that stop a run and executes the main one: they stay blocked, and wait
// until the main program handles them (cli/interrupt.h).

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "adamas/stopping_signals.h"
#include "cli/exit_status.h"

namespace {

/// The paths of the main program relative to the launcher: in the build folder, and installed.
constexpr std::array<const char*, 2> kPlaces{"adamas-main", ADAMAS_INSTALLED_MAIN};

}  // namespace

int main(int, char** argv) {
  const sigset_t stopping = adamas::stopping_signals();
  sigprocmask(SIG_BLOCK, &stopping, nullptr);
  std::array<char, 8192> path{};
  const std::size_t most = path.size() / 2;
  const ssize_t length = readlink("/proc/self/exe", path.data(), most);
  const bool known = length > 0 && static_cast<std::size_t>(length) < most;
  char* const name = known ? std::strrchr(path.data(), '/') + 1 : path.data();
  int reason = length < 0 ? errno : known ? 0 : ENAMETOOLONG;
  for (const char* place : kPlaces) {
    if (!known) break;
    std::strcpy(name, place);
    execv(path.data(), argv);
    if (reason == 0 || errno != ENOENT) reason = errno;
  }
  std::fprintf(stderr,
               "adamas: error: expected the program 'adamas-main' beside adamas or where it is installed, "
               "found none: %s\n",
               std::strerror(reason));
  return adamas::cli::kFailed;
}
