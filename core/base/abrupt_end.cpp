#include "core/base/abrupt_end.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>

namespace adamas::inline core {

namespace {

struct Temporary {
  std::atomic<bool> taken = false, used = false;
  std::atomic<pid_t> owner = 0;
  std::array<char, 4096> folder{};
  std::array<char, 256> beginning{};
};

struct Group {
  std::atomic<pid_t> number = 0, owner = 0;
};

std::array<Temporary, 32> temporaries;
std::array<Group, 32> groups;

/// Calls visit(name) for the entries of a folder. It makes the system call itself, since libraries allocate
/// memory for that, which a signal handler must not.
template <class Visit>
void for_each_entry(int folder, char* entries, std::size_t size, Visit&& visit) {
  for (long count = 0; (count = syscall(SYS_getdents64, folder, entries, size)) > 0;) {
    for (long at = 0; at < count;) {
      const auto* entry = reinterpret_cast<const dirent64*>(entries + at);
      visit(static_cast<const char*>(entry->d_name));
      at += entry->d_reclen;
    }
  }
}

constexpr std::size_t kMostDepth = 12;
alignas(dirent64) std::array<std::array<char, 8192>, kMostDepth> entries_at_depth;

bool is_itself_or_above(const char* name) {
  return std::strcmp(name, ".") == 0 || std::strcmp(name, "..") == 0;
}

/// Removes a file, or a folder with all in it. Returns whether it is gone.
bool remove_entry(int above, const char* name, std::size_t depth) {
  if (unlinkat(above, name, 0) == 0 || errno == ENOENT) return true;
  const int folder = openat(above, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder < 0) return false;
  if (depth < kMostDepth) {
    for_each_entry(folder, entries_at_depth[depth].data(), entries_at_depth[depth].size(),
                   [&](const char* inner) {
                     if (!is_itself_or_above(inner)) remove_entry(folder, inner, depth + 1);
                   });
  }
  close(folder);
  return unlinkat(above, name, AT_REMOVEDIR) == 0;
}

/// Removes a file or folder after giving it another name: other threads, which still run, do not know that
/// name and can put nothing into the folder.
bool remove_renamed(int above, const char* name) {
  std::array<char, 264> other{};
  if (std::strlen(name) + sizeof("-") > other.size()) return remove_entry(above, name, 0);
  std::strcpy(other.data(), name);
  std::strcat(other.data(), "-");
  return remove_entry(above, renameat(above, name, above, other.data()) == 0 ? other.data() : name, 0);
}

void remove_alike(const Temporary& temporary) {
  alignas(dirent64) static std::array<char, 32768> entries;
  const int folder = open(temporary.folder.data(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  const char* const first = temporary.beginning.data();
  bool are_gone = true;
  for_each_entry(folder, entries.data(), entries.size(), [&](const char* name) {
    if (std::strncmp(name, first, std::strlen(first)) == 0 && std::strcmp(name, first) != 0)
      are_gone = remove_renamed(folder, name) && are_gone;
  });
  if (are_gone) unlinkat(folder, first, 0);
  close(folder);
}

}  // namespace

RemovedAtAbruptEnd::RemovedAtAbruptEnd(const std::filesystem::path& folder, const std::string& beginning) {
  const std::string place = std::filesystem::absolute(folder).string();
  for (Temporary& entry : temporaries) {
    // The last byte of each text stays zero, so that a handler that reads meanwhile finds its end.
    if (place.size() >= entry.folder.size() || beginning.size() >= entry.beginning.size()) return;
    if (beginning.empty() || entry.taken.exchange(true)) continue;
    std::memcpy(entry.folder.data(), place.c_str(), place.size() + 1);
    std::memcpy(entry.beginning.data(), beginning.c_str(), beginning.size() + 1);
    entry.owner = getpid();
    entry.used = true;
    used_ = &entry.used;
    return;
  }
}

RemovedAtAbruptEnd::~RemovedAtAbruptEnd() {
  if (used_ == nullptr) return;
  *used_ = false;
  for (Temporary& entry : temporaries) {
    if (&entry.used == used_) entry.taken = false;
  }
}

EndedAtAbruptEnd::EndedAtAbruptEnd(pid_t group) {
  for (Group& entry : groups) {
    pid_t none = 0;
    if (!entry.number.compare_exchange_strong(none, group)) continue;
    entry.owner = getpid();
    group_ = &entry.number;
    return;
  }
}

EndedAtAbruptEnd::~EndedAtAbruptEnd() {
  if (group_ != nullptr) *group_ = 0;
}

}  // namespace adamas::inline core

namespace adamas {

void clean_up_at_abrupt_end() {
  const pid_t self = getpid();
  for (const Group& entry : groups) {
    const pid_t group = entry.number;
    if (group > 1 && entry.owner == self) kill(-group, SIGKILL);
  }
  for (const Temporary& entry : temporaries) {
    if (entry.used && entry.owner == self) remove_alike(entry);
  }
}

}  // namespace adamas
