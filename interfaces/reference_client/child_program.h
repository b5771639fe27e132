#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adamas/error.h"
#include "adamas/progress.h"
#include "interfaces/reference_client/message.h"

namespace adamas::interfaces {

/// Limits of a child process, which are set before its program starts.
struct ChildLimits {
  double seconds = 300;      ///< elapsed time; 0: no limit
  double whole_seconds = 0;  ///< the whole limit, of which `seconds` are left, for messages; 0: `seconds` is
                             ///< the whole limit
  std::size_t memory_bytes = std::size_t{8} << 30;  ///< of address space; 0: no limit

  static constexpr ChildLimits none() { return {0, 0, 0}; }
};

/// The result of a child process.
struct ChildResult {
  /// The reason, in words, why the output cannot be trusted; empty if the program ended with status 0.
  std::string failure;
  bool crashed = false;      ///< whether the program ended by a signal of its own
  std::vector<char> output;  ///< the bytes that it wrote to its standard output
};

/// Runs a program with `input` as its standard input. This uses no threads, pipes or files on disk: input and
/// output are in anonymous memory. When this returns, the program and all processes that it has started have
/// ended. Throws Cancelled if the progress requests it, and Error if no process can be made.
ChildResult run_child_program(const std::filesystem::path& program, const std::vector<char>& input,
                              const ChildLimits& limits,
                              const Progress& progress = SilentProgress::instance());

/// The program adamas-reference has failed. The message is the ChildResult's failure.
class ProgramFailure : public Error {
 public:
  using Error::Error;
};

/// A program's reply, or the reason why there is none.
template <class Reply>
struct ProgramAnswer {
  std::string failure;   ///< empty if there is a reply
  bool crashed = false;  ///< whether the program ended by a signal of its own
  std::optional<Reply> reply;
};

/// Runs a program that takes messages (message.h) with a request. Throws as run_child_program() does.
template <class Reply, class Request>
ProgramAnswer<Reply> ask_program(const std::filesystem::path& program, const Request& request,
                                 const ChildLimits& limits, const Progress& progress) {
  ChildResult child = run_child_program(program, encode(request), limits, progress);
  ProgramAnswer<Reply> answer{std::move(child.failure), child.crashed, std::nullopt};
  if (!answer.failure.empty()) return answer;
  answer.reply = decode<Reply>(std::move(child.output));
  if (!answer.reply) answer.failure = "gave no answer that can be read";
  return answer;
}

}  // namespace adamas::interfaces
