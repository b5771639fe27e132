#include "core/base/partial_names.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <map>
#include <mutex>
#include <string_view>
#include <system_error>
#include <vector>

namespace adamas::inline core {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBeginning = ".partial-";
constexpr std::size_t kLetters = 6;

bool is_mark(std::string_view name) {
  return name.size() == kBeginning.size() + kLetters && name.starts_with(kBeginning) &&
         std::all_of(name.end() - kLetters, name.end(),
                     [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; });
}

/// Whether the file is locked now, and still is in its folder.
bool lock(int file) {
  struct stat status {};
  return ::flock(file, LOCK_EX | LOCK_NB) == 0 && ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) &&
         status.st_size == 0 && status.st_nlink > 0;
}

/// Removes what belongs to a mark that no living run has locked.
void remove_with(const fs::path& folder, const std::string& mark, const std::vector<std::string>& names) {
  const int file = ::open((folder / mark).c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return;
  if (lock(file)) {
    std::error_code code;
    for (const std::string& name : names) {
      if (name.starts_with(mark + "-")) fs::remove_all(folder / name, code);
    }
    // The mark goes last, so that what could not be removed now is found again, and while it is locked.
    const bool is_clean = std::none_of(names.begin(), names.end(), [&](const std::string& name) {
      return name.starts_with(mark + "-") && fs::exists(fs::symlink_status(folder / name, code));
    });
    if (is_clean) ::unlink((folder / mark).c_str());
  }
  ::close(file);
}

void remove_left_over(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code code;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    std::string name = entry->path().filename().string();
    if (name.starts_with(kBeginning)) names.push_back(std::move(name));
  }
  for (const std::string& name : names) {
    if (is_mark(name)) remove_with(folder, name, names);
  }
}

}  // namespace

std::shared_ptr<PartialNames> PartialNames::in(const fs::path& folder) {
  static std::mutex mutex;
  static std::map<fs::path, std::weak_ptr<PartialNames>> known;
  const std::lock_guard guard(mutex);
  const fs::path place = fs::absolute(folder).lexically_normal();
  const auto [entry, is_first] = known.try_emplace(place);
  if (is_first) remove_left_over(place);
  std::shared_ptr<PartialNames> names = entry->second.lock();
  if (!names) {
    names.reset(new PartialNames(folder));
    entry->second = names;
  }
  return names;
}

PartialNames::PartialNames(fs::path folder) : folder_(std::move(folder)) {
  // Another run may take the file for one that was left, in the moment before it is locked.
  while (!make_locked_file()) {
  }
  at_abrupt_end_.emplace(folder_, mark_.filename().string());
}

bool PartialNames::make_locked_file() {
  std::string name = (folder_ / kBeginning).string() + std::string(kLetters, 'X');
  file_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (file_ < 0) throw std::system_error(errno, std::generic_category());
  mark_ = name;
  if (lock(file_)) return true;
  // If files cannot be locked, no run regards this one as left behind.
  const bool is_locked_by_another = errno == EWOULDBLOCK;
  struct stat status {};
  if (!is_locked_by_another && ::fstat(file_, &status) == 0 && status.st_nlink > 0) return true;
  ::close(file_);
  return false;
}

PartialNames::~PartialNames() {
  // The mark is removed while it is locked, so that no other run removes it.
  ::unlink(mark_.c_str());
  ::close(file_);
}

fs::path PartialNames::next(const std::string& extension) const {
  static std::atomic<unsigned> count = 0;
  return mark_.string() + "-" + std::to_string(count++) + extension;
}

}  // namespace adamas::inline core
