#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"

namespace adamas::interfaces {

/// Limits of a child process, set before its program starts.
struct ChildLimits {
  double seconds = 300;                             ///< by the clock
  double whole_seconds = 0;                         ///< what they are left of, for messages; 0: nothing more
  std::size_t memory_bytes = std::size_t{8} << 30;  ///< of address space
};

/// How a child ended.
struct ChildResult {
  /// Why there is no output that can be trusted, in words; empty where the program ended with status 0.
  std::string failure;
  bool crashed = false;      ///< ended by a signal of its own
  std::vector<char> output;  ///< what it wrote to its standard output
};

/// Runs a program with `input` as its standard input, without threads, pipes or files of its own: what goes
/// in and out lies in anonymous memory. Whatever the program does, it and the processes it starts are gone
/// when this returns. Throws Cancelled where the progress says so, and Error where no process can be made.
ChildResult run_child_program(const std::filesystem::path& program, const std::vector<char>& input,
                              const ChildLimits& limits,
                              const Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
