#pragma once

#include <sys/types.h>

#include <atomic>
#include <filesystem>
#include <string>

namespace adamas::inline core {

// These classes record what a run would leave behind if a signal ended it at once, without destructors. The
// record is fixed memory that a signal handler may read. It has room for a few dozen entries; further ones
// are not recorded.

/// Temporary files and folders that an abrupt end removes while this object lives: all in `folder` whose
/// names begin with `beginning`, folders with their contents. The file whose name is just `beginning` is
/// removed last, and only if all others could be removed, so that the next run finds what is left.
class RemovedAtAbruptEnd {
 public:
  RemovedAtAbruptEnd(const std::filesystem::path& folder, const std::string& beginning);
  ~RemovedAtAbruptEnd();
  RemovedAtAbruptEnd(const RemovedAtAbruptEnd&) = delete;
  RemovedAtAbruptEnd& operator=(const RemovedAtAbruptEnd&) = delete;

 private:
  std::atomic<bool>* used_ = nullptr;
};

/// A group of processes that an abrupt end kills while this object lives.
class EndedAtAbruptEnd {
 public:
  explicit EndedAtAbruptEnd(pid_t group);
  ~EndedAtAbruptEnd();
  EndedAtAbruptEnd(const EndedAtAbruptEnd&) = delete;
  EndedAtAbruptEnd& operator=(const EndedAtAbruptEnd&) = delete;

 private:
  std::atomic<pid_t>* group_ = nullptr;
};

}  // namespace adamas::inline core
