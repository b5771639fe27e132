#pragma once

#include <sys/types.h>

#include <atomic>
#include <filesystem>
#include <string>

namespace adamas {

/// What a run leaves behind where it ends at once, by a signal, without destructors: kept in fixed memory
/// that a signal handler may read. Of more than a few dozen at a time the others are not remembered.

/// While it lives: temporary files and folders of a folder, known by how their names begin. Folders go with
/// the files in them.
class RemovedAtAbruptEnd {
 public:
  RemovedAtAbruptEnd(const std::filesystem::path& folder, const std::string& beginning);
  ~RemovedAtAbruptEnd();
  RemovedAtAbruptEnd(const RemovedAtAbruptEnd&) = delete;
  RemovedAtAbruptEnd& operator=(const RemovedAtAbruptEnd&) = delete;

 private:
  std::atomic<bool>* used_ = nullptr;
};

/// While it lives: the processes of a group.
class EndedAtAbruptEnd {
 public:
  explicit EndedAtAbruptEnd(pid_t group);
  ~EndedAtAbruptEnd();
  EndedAtAbruptEnd(const EndedAtAbruptEnd&) = delete;
  EndedAtAbruptEnd& operator=(const EndedAtAbruptEnd&) = delete;

 private:
  std::atomic<pid_t>* group_ = nullptr;
};

/// Ends and removes what is remembered, with calls that a signal handler may make. In a child that was forked
/// it does nothing: all that is the parent's.
void clean_up_at_abrupt_end();

}  // namespace adamas
