#pragma once

#include <filesystem>

#include "core/base/error.h"

namespace adamas::timevarying {

/// The right to add steps to a store, which only one process has at a time. Reading does not need it. The
/// system releases it when the process ends, in whatever way.
class StoreLock {
 public:
  /// Throws Error, which names the file, if it is missing or cannot be written, if another process has the
  /// right, or if the file system has no locks.
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
