#pragma once

#include <sys/types.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/abrupt_end.h"

namespace adamas::inline core {

/// A program to start, and what it may use.
struct ChildSetup {
  std::filesystem::path program;
  std::vector<std::string> arguments{};  ///< without the program's name
  /// The beginning of the message where no process can be made: "F.vtk: no process for its reader".
  std::string complaint;
  /// Open files that become its standard input, output and error. A stream that is -1 is empty, and what is
  /// written to it is lost.
  std::array<int, 3> streams{-1, -1, -1};
  /// Whether the child and what it starts are a process group, which is ended as a whole. Otherwise the child
  /// gets the signals of the terminal, as this program does.
  bool own_group = false;
  std::size_t memory_bytes = 0;  ///< limit of the address space; 0: that of this process
  std::size_t file_bytes = 0;    ///< limit of each file that it writes; 0: that of this process
  double cpu_seconds = 0;        ///< limit of processor time; 0: that of this process
  unsigned alarm_seconds = 0;    ///< time until it gets SIGALRM; 0: never
};

/// A program that runs apart from this one, which may have any number of threads. It has no open files but
/// its streams, leaves no core, and is ended with this object, or with the thread that made it.
class ChildProcess {
 public:
  /// The status with which a child exits whose program could not be started, as shells have it.
  static constexpr int kNotStarted = 127;
  /// The status with which it exits where too many files are open to give it its streams.
  static constexpr int kTooManyFiles = 126;

  /// Throws Error where no process can be made.
  explicit ChildProcess(const ChildSetup& setup);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Returns at once whether the child has ended.
  [[nodiscard]] bool has_ended();
  /// Waits for the child's end. Returns the status of waitpid.
  int wait();

 private:
  bool wait(int how);

  pid_t child_ = 0;
  bool own_group_;
  std::optional<EndedAtAbruptEnd> at_abrupt_end_;
  int status_ = 0;
  bool ended_ = false;
};

/// Finds a program in the folders that PATH names; empty where there is none.
std::filesystem::path find_program(const std::string& name);

/// Finds a program that is installed with this library: where set_own_program() or, without it, the
/// environment variable says, beside the running program, in ../libexec of that, or where this library was to
/// be installed when it was configured. Throws Error where there is none.
std::filesystem::path find_own_program(const std::string& name, const std::string& variable);
/// Sets the path of such a program; an empty path takes it back.
void set_own_program(const std::string& name, const std::filesystem::path& path);

}  // namespace adamas::inline core
