#include "interfaces/reference_client/child_program.h"

#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <cstring>
#include <thread>

#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/base/unnamed_file.h"

namespace adamas::interfaces {

namespace {

using Clock = std::chrono::steady_clock;

/// A failure quotes at most this many bytes from the end of a program's output.
constexpr std::size_t kMostWords = 200;

/// Returns the last line that the program has printed, in parentheses.
std::string last_words(const MemoryFile& words) {
  const std::vector<char> bytes = words.content();
  std::string text(bytes.begin(), bytes.end());
  text.erase(text.find_last_not_of(" \n\r\t") + 1);
  const std::size_t line = text.find_last_of('\n');
  if (line != std::string::npos) text.erase(0, line + 1);
  if (text.size() > kMostWords) text.erase(0, text.size() - kMostWords);
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '?';
  }
  return text.empty() ? "" : " (it said: " + text + ")";
}

std::string took_longer(const ChildLimits& limits) {
  return fmt::format("took longer than {:.6g} s",
                     limits.whole_seconds > 0 ? limits.whole_seconds : limits.seconds);
}

std::string failure_of(int status, const ChildLimits& limits) {
  if (WIFEXITED(status)) {
    if (WEXITSTATUS(status) == 0) return "";
    if (WEXITSTATUS(status) == ChildProcess::kNotStarted) return "could not be started";
    if (WEXITSTATUS(status) == ChildProcess::kTooManyFiles)
      return "too many files are open for it (ulimit -n)";
    return fmt::format("ended with status {}", WEXITSTATUS(status));
  }
  const int number = WTERMSIG(status);
  if (number == SIGXCPU) return took_longer(limits);
  return fmt::format("was ended by signal {}, {}", number, ::strsignal(number));
}

}  // namespace

ChildResult run_child_program(const std::filesystem::path& program, const std::vector<char>& input,
                              const ChildLimits& limits, const Progress& progress) {
  progress.check();
  const MemoryFile in("adamas-request"), out("adamas-reply"), words("adamas-messages");
  in.fill(input);
  ChildSetup setup;
  setup.program = program;
  setup.complaint = program.string() + ": no process for it";
  setup.streams = {in.descriptor(), out.descriptor(), words.descriptor()};
  setup.own_group = true;
  setup.memory_bytes = setup.file_bytes = limits.memory_bytes;
  // The parent watches the time; this limit is for a child that outlives the parent.
  if (limits.seconds > 0) setup.cpu_seconds = limits.seconds + 1;
  ChildProcess child(setup);
  const auto start = Clock::now();
  while (!child.has_ended()) {
    progress.check();
    if (limits.seconds > 0 && std::chrono::duration<double>(Clock::now() - start).count() > limits.seconds)
      return {took_longer(limits), false, {}};
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const int status = child.wait();
  ChildResult result{failure_of(status, limits), WIFSIGNALED(status) && WTERMSIG(status) != SIGXCPU,
                     out.content()};
  if (!result.failure.empty()) result.failure += last_words(words);
  return result;
}

}  // namespace adamas::interfaces
