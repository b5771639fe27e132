#include "core/base/abrupt_end.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstring>

namespace adamas {

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

void remove_folder(int above, const char* name) {
  alignas(dirent64) static std::array<char, 32768> entries;
  const int folder = openat(above, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder < 0) return;
  for_each_entry(folder, entries.data(), entries.size(),
                 [&](const char* file) { unlinkat(folder, file, 0); });
  close(folder);
  unlinkat(above, name, AT_REMOVEDIR);
}

void remove_alike(const Temporary& temporary) {
  alignas(dirent64) static std::array<char, 32768> entries;
  const int folder = open(temporary.folder.data(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  const std::size_t length = std::strlen(temporary.beginning.data());
  for_each_entry(folder, entries.data(), entries.size(), [&](const char* name) {
    if (std::strncmp(name, temporary.beginning.data(), length) != 0) return;
    if (unlinkat(folder, name, 0) != 0) remove_folder(folder, name);
  });
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
