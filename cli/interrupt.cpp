#include "cli/interrupt.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>

namespace adamas {

namespace {

constexpr int kInterruptedStatus = 130;

/// What the temporary files of one output have in common. Fixed memory, for the signal handler reads it.
struct Temporary {
  std::array<char, 4096> folder;
  std::array<char, 256> beginning;  ///< of the names
  bool whole;                       ///< the folder too
};

volatile std::sig_atomic_t flag = 0;
pid_t program = 0;
std::array<Temporary, 32> temporaries;
std::atomic<std::size_t> temporary_count = 0;

/// Removes the files of a folder that begin so, with calls that a signal handler may make: no library looks
/// into folders without allocating, and a thread of its own would be there when readers fork.
void remove_alike(const Temporary& temporary) {
  alignas(dirent64) static std::array<char, 32768> entries;
  const int folder = open(temporary.folder.data(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  const std::size_t length = std::strlen(temporary.beginning.data());
  for (long size = 0; (size = syscall(SYS_getdents64, folder, entries.data(), entries.size())) > 0;) {
    for (long at = 0; at < size;) {
      const auto* entry = reinterpret_cast<const dirent64*>(entries.data() + at);
      const char* name = static_cast<const char*>(entry->d_name);
      if (std::strncmp(name, temporary.beginning.data(), length) == 0) unlinkat(folder, name, 0);
      at += entry->d_reclen;
    }
  }
  close(folder);
  if (temporary.whole) rmdir(temporary.folder.data());
}

void remember(const std::string& folder, const std::string& beginning, bool whole) {
  const std::size_t next = temporary_count;
  if (next == temporaries.size()) return;
  Temporary& entry = temporaries[next];
  if (folder.size() >= entry.folder.size() || beginning.size() >= entry.beginning.size()) return;
  std::strcpy(entry.folder.data(), folder.c_str());
  std::strcpy(entry.beginning.data(), beginning.c_str());
  entry.whole = whole;
  temporary_count = next + 1;
}

extern "C" void handle_signal(int) {
  const int before = errno;
  if (flag != 0) {
    // A child that reads a file has no outputs.
    for (std::size_t i = 0; getpid() == program && i < temporary_count; ++i) remove_alike(temporaries[i]);
    _exit(kInterruptedStatus);
  }
  flag = 1;
  errno = before;
}

}  // namespace

void catch_signals() {
  program = getpid();
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
  const std::string stem = temporary.stem().string();
  const std::string beginning = stem.substr(0, stem.rfind('-') + 1);
  if (!beginning.empty())
    remember(std::filesystem::absolute(temporary).parent_path().string(), beginning, false);
}

void remove_folder_at_abrupt_end(const std::filesystem::path& temporary) {
  remember(std::filesystem::absolute(temporary).string(), "", true);
}

}  // namespace adamas
