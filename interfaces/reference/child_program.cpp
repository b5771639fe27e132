#include "interfaces/reference/child_program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

#include "core/base/abrupt_end.h"
#include "core/base/stopping_signals.h"

namespace adamas {

namespace {

using Clock = std::chrono::steady_clock;

/// Status of a child whose program could not be started, as shells have it.
constexpr int kNotStarted = 127;
/// What a program says of itself is cut off after so many bytes from its end.
constexpr std::size_t kMostWords = 200;

/// A file without a name that is gone with its descriptor.
class AnonymousFile {
 public:
  explicit AnonymousFile(const char* name) : descriptor_(::memfd_create(name, MFD_CLOEXEC)) {
    if (descriptor_ < 0)
      fail("no memory for what a separate program reads and writes: {}", std::strerror(errno));
  }
  ~AnonymousFile() { ::close(descriptor_); }
  AnonymousFile(const AnonymousFile&) = delete;
  AnonymousFile& operator=(const AnonymousFile&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }

  void fill(const std::vector<char>& bytes) const {
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t size = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
      if (size < 0 && errno == EINTR) continue;
      if (size <= 0) fail("no memory for what a separate program reads: {}", std::strerror(errno));
      done += static_cast<std::size_t>(size);
    }
    ::lseek(descriptor_, 0, SEEK_SET);
  }

  [[nodiscard]] std::vector<char> content() const {
    std::vector<char> bytes(static_cast<std::size_t>(std::max<off_t>(::lseek(descriptor_, 0, SEEK_END), 0)));
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t size =
          ::pread(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
      if (size < 0 && errno == EINTR) continue;
      if (size <= 0) break;
      done += static_cast<std::size_t>(size);
    }
    bytes.resize(done);
    return bytes;
  }

 private:
  int descriptor_;
};

rlimit lowered(int resource, double value) {
  rlimit limit{};
  ::getrlimit(static_cast<__rlimit_resource>(resource), &limit);
  const double most = 9e18;
  const auto wanted = static_cast<rlim_t>(std::min(value, most));
  if (limit.rlim_max == RLIM_INFINITY || wanted < limit.rlim_max) limit.rlim_max = wanted;
  limit.rlim_cur = limit.rlim_max;
  return limit;
}

/// What the child needs between fork and exec, worked out before: there it may allocate nothing.
struct ChildSetup {
  const char* program;
  std::array<char*, 2> arguments;
  std::array<int, 3> streams;
  rlimit memory, time, file_size, core;
  pid_t parent;
};

/// Only calls that are safe in the child of a process with threads.
[[noreturn]] void become_program(const ChildSetup& setup) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != setup.parent) ::_exit(kNotStarted);
  struct sigaction standard {};
  standard.sa_handler = SIG_DFL;
  for (const int number : kStoppingSignals) {
    if (!is_ignored(number)) ::sigaction(number, &standard, nullptr);
  }
  for (const int number : {SIGPIPE, SIGXFSZ, SIGALRM}) ::sigaction(number, &standard, nullptr);
  for (int stream = 0; stream < 3; ++stream) ::dup2(setup.streams[static_cast<std::size_t>(stream)], stream);
  ::setrlimit(RLIMIT_CORE, &setup.core);
  ::setrlimit(RLIMIT_FSIZE, &setup.file_size);
  ::setrlimit(RLIMIT_CPU, &setup.time);
  ::setrlimit(RLIMIT_AS, &setup.memory);
  ::execv(setup.program, setup.arguments.data());
  ::_exit(kNotStarted);
}

/// Ends the child and all it has started, whichever way this scope is left.
class ChildGuard {
 public:
  explicit ChildGuard(pid_t child) : child_(child), at_abrupt_end_(child) { ::setpgid(child, child); }
  ~ChildGuard() {
    ::kill(-child_, SIGKILL);
    if (!ended_) wait(0);
  }
  ChildGuard(const ChildGuard&) = delete;
  ChildGuard& operator=(const ChildGuard&) = delete;

  /// Whether it has ended; `how` as for waitpid.
  bool wait(int how) {
    pid_t found = 0;
    while ((found = ::waitpid(child_, &status_, how)) < 0 && errno == EINTR) {
    }
    ended_ = found != 0;
    return ended_;
  }
  [[nodiscard]] int status() const { return status_; }

 private:
  pid_t child_;
  EndedAtAbruptEnd at_abrupt_end_;
  int status_ = 0;
  bool ended_ = false;
};

/// The last line that the program has printed, in parentheses.
std::string last_words(const AnonymousFile& words) {
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
    if (WEXITSTATUS(status) == kNotStarted) return "could not be started";
    return fmt::format("ended with status {}", WEXITSTATUS(status));
  }
  const int number = WTERMSIG(status);
  if (number == SIGXCPU) return took_longer(limits);
  return fmt::format("was ended by signal {}, {}", number, ::strsignal(number));
}

}  // namespace

ChildResult run_child_program(const std::filesystem::path& program, const std::vector<char>& input,
                              const ChildLimits& limits, const Progress& progress) {
  const AnonymousFile in("adamas-request"), out("adamas-reply"), words("adamas-messages");
  in.fill(input);
  std::string name = program.string();
  ChildSetup setup{};
  setup.program = name.c_str();
  setup.arguments = {name.data(), nullptr};
  setup.streams = {in.descriptor(), out.descriptor(), words.descriptor()};
  const auto memory = static_cast<double>(limits.memory_bytes);
  setup.memory = lowered(RLIMIT_AS, memory);
  setup.file_size = lowered(RLIMIT_FSIZE, memory);
  // The clock is watched here; this is for a child that outlives the watch.
  setup.time = lowered(RLIMIT_CPU, std::ceil(limits.seconds) + 1);
  setup.parent = ::getpid();
  // _Fork: handlers that libraries have for forks belong to children that go on with their code.
  const pid_t child = ::_Fork();
  if (child < 0) fail("{}: no process for it: {}", name, std::strerror(errno));
  if (child == 0) become_program(setup);
  ChildGuard guard(child);
  const auto deadline = Clock::now() + std::chrono::duration<double>(limits.seconds);
  while (!guard.wait(WNOHANG)) {
    progress.check();
    if (Clock::now() > deadline) return {took_longer(limits), false, {}};
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const int status = guard.status();
  ChildResult result{failure_of(status, limits), WIFSIGNALED(status) && WTERMSIG(status) != SIGXCPU,
                     out.content()};
  if (!result.failure.empty()) result.failure += last_words(words);
  return result;
}

}  // namespace adamas
