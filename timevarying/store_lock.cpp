#include "timevarying/store_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace adamas::timevarying {

StoreLock::StoreLock(std::filesystem::path path) : path_(std::move(path)) {
  file_ = ::open(path_.c_str(), O_RDWR | O_CLOEXEC);
  if (file_ < 0) fail("{}: cannot be written: {}", path_.string(), std::strerror(errno));
  try {
    lock();
  } catch (...) {
    ::close(file_);
    throw;
  }
}

StoreLock::~StoreLock() { ::close(file_); }

void StoreLock::lock() const {
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK)
      fail("{}: expected one run at a time that adds steps to it, found another at work", path_.string());
    fail("{}: cannot be locked, so that no other run adds steps meanwhile: {}", path_.string(),
         std::strerror(errno));
  }
  // Another file may have taken the name since this one was opened.
  struct stat locked {
  }, named{};
  if (::fstat(file_, &locked) != 0 || ::stat(path_.c_str(), &named) != 0 || locked.st_dev != named.st_dev ||
      locked.st_ino != named.st_ino)
    fail("{}: expected the same store for as long as steps are added, found it replaced", path_.string());
}

}  // namespace adamas::timevarying
