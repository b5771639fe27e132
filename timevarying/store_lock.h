#pragma once

#include <filesystem>

#include "core/base/error.h"

namespace adamas::timevarying {

/// The right to add steps to a store, which one process has at a time. Reading needs none. The system takes
/// it away when the process ends, however it ends.
class StoreLock {
 public:
  /// Throws Error, which names the file, where it is missing or cannot be written, where another process has
  /// the right, and where the file system has no locks.
  explicit StoreLock(std::filesystem::path path);
  ~StoreLock();
  StoreLock(const StoreLock&) = delete;
  StoreLock& operator=(const StoreLock&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  void lock() const;

  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace adamas::timevarying
