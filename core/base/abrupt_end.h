#pragma once

#include <sys/types.h>

#include <atomic>
#include <filesystem>
#include <string>

namespace adamas::inline core {

// What a run would leave behind where a signal ends it at once, without destructors. It is remembered in
// fixed memory that a signal handler may read; of more than a few dozen things at a time the others are
// forgotten.

/// Temporary files and folders that an abrupt end removes while this object lives: all in `folder` whose
/// names begin alike, folders with what is in them. The one whose name is this beginning goes last, and stays
/// where another could not be removed, so that the next run finds that.
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
