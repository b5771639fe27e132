#include "core/base/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <utility>

#include "adamas/stopping_signals.h"
#include "core/base/error.h"

namespace adamas::inline core {

namespace {

/// The signals that end a child which exceeds its limits. This process may ignore or block them; the child
/// must not.
constexpr std::array<int, 4> kLimitingSignals{SIGPIPE, SIGALRM, SIGXCPU, SIGXFSZ};

/// What the child needs between fork and exec, worked out before: there it may allocate nothing.
struct Preparation {
  const char* program = nullptr;
  std::vector<char*> arguments;  ///< a null pointer at the end
  std::array<int, 3> streams{};
  bool own_group = false;
  std::vector<std::pair<int, rlimit>> limits;
  unsigned alarm_seconds = 0;
  pid_t parent = 0;
  sigset_t mask{};
};

/// A limit of a resource, which is never above that of this process.
std::pair<int, rlimit> lowered(int resource, double value) {
  rlimit limit{};
  ::getrlimit(static_cast<__rlimit_resource>(resource), &limit);
  const auto wanted = static_cast<rlim_t>(std::min(value, 9e18));
  if (limit.rlim_max == RLIM_INFINITY || wanted < limit.rlim_max) limit.rlim_max = wanted;
  limit.rlim_cur = limit.rlim_max;
  return {resource, limit};
}

std::vector<std::pair<int, rlimit>> limits_of(const ChildSetup& setup) {
  std::vector<std::pair<int, rlimit>> limits{lowered(RLIMIT_CORE, 0)};
  if (setup.file_bytes > 0) limits.push_back(lowered(RLIMIT_FSIZE, static_cast<double>(setup.file_bytes)));
  if (setup.cpu_seconds > 0) limits.push_back(lowered(RLIMIT_CPU, std::ceil(setup.cpu_seconds)));
  if (setup.memory_bytes > 0) limits.push_back(lowered(RLIMIT_AS, static_cast<double>(setup.memory_bytes)));
  return limits;
}

/// Makes three descriptors the standard streams. Copies above those of the streams come first, so that none
/// is overwritten before it is used. Returns false where there are too few descriptors.
bool set_streams(std::array<int, 3> streams) {
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int& stream : streams) {
    stream = ::fcntl(stream < 0 ? nowhere : stream, F_DUPFD_CLOEXEC, 3);
    if (stream < 0) return false;
  }
  for (int stream = 0; stream < 3; ++stream) ::dup2(streams[static_cast<std::size_t>(stream)], stream);
  ::close_range(3, ~0u, 0);
  return true;
}

/// Sets how the child reacts to signals. A signal that asks a program to end stays ignored where this process
/// ignores it, as under nohup.
void set_signals(const sigset_t& mask) {
  struct sigaction standard {};
  standard.sa_handler = SIG_DFL;
  for (const int number : kStoppingSignals) {
    if (!is_ignored(number)) ::sigaction(number, &standard, nullptr);
  }
  for (const int number : kLimitingSignals) ::sigaction(number, &standard, nullptr);
  ::sigprocmask(SIG_SETMASK, &mask, nullptr);
}

/// Becomes the program, in the child. It makes only calls that are safe in the child of a process with
/// threads.
[[noreturn]] void become_program(const Preparation& prepared) {
  if (prepared.own_group) ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != prepared.parent) ::_exit(ChildProcess::kNotStarted);
  if (!set_streams(prepared.streams)) ::_exit(ChildProcess::kTooManyFiles);
  for (const auto& [resource, limit] : prepared.limits) {
    ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
  }
  ::alarm(prepared.alarm_seconds);
  set_signals(prepared.mask);
  ::execv(prepared.program, prepared.arguments.data());
  ::_exit(ChildProcess::kNotStarted);
}

/// Starts the child. No signal is handled in it before its program runs, since handlers would do there what
/// this process has to do.
pid_t start(Preparation& prepared) {
  sigset_t all{}, before{};
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  prepared.mask = before;
  for (const int number : kLimitingSignals) sigdelset(&prepared.mask, number);
  // _Fork skips the fork handlers of libraries, which are meant for children that go on running the
  // libraries' code.
  const pid_t child = ::_Fork();
  if (child == 0) become_program(prepared);
  const int reason = errno;
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = reason;
  return child;
}

bool can_run(const std::filesystem::path& path) {
  std::error_code code;
  return std::filesystem::is_regular_file(path, code) && ::access(path.c_str(), X_OK) == 0;
}

/// The paths of programs that were set in this process, by name. The environment would not do: it must not be
/// changed beside other threads.
class OwnPrograms {
 public:
  static OwnPrograms& instance() {
    static OwnPrograms programs;
    return programs;
  }
  void set(const std::string& name, const std::filesystem::path& path) {
    const std::lock_guard lock(mutex_);
    paths_[name] = path;
  }
  [[nodiscard]] std::filesystem::path find(const std::string& name) {
    const std::lock_guard lock(mutex_);
    const auto found = paths_.find(name);
    return found == paths_.end() ? std::filesystem::path() : found->second;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::filesystem::path> paths_;
};

}  // namespace

ChildProcess::ChildProcess(const ChildSetup& setup) : own_group_(setup.own_group) {
  std::string name = setup.program.string();
  Preparation prepared;
  prepared.program = name.c_str();
  std::vector<std::string> arguments = setup.arguments;
  prepared.arguments.push_back(name.data());
  for (std::string& argument : arguments) prepared.arguments.push_back(argument.data());
  prepared.arguments.push_back(nullptr);
  prepared.streams = setup.streams;
  prepared.own_group = own_group_;
  prepared.limits = limits_of(setup);
  prepared.alarm_seconds = setup.alarm_seconds;
  prepared.parent = ::getpid();
  child_ = start(prepared);
  if (child_ < 0) fail("{}: {}", setup.complaint, std::strerror(errno));
  if (!own_group_) return;
  // The child makes the same call: whichever process runs first, the group exists.
  ::setpgid(child_, child_);
  at_abrupt_end_.emplace(child_);
}

ChildProcess::~ChildProcess() {
  if (own_group_) ::kill(-child_, SIGKILL);
  if (ended_) return;
  ::kill(child_, SIGKILL);
  wait(0);
}

bool ChildProcess::wait(int how) {
  pid_t found = 0;
  while (!ended_ && (found = ::waitpid(child_, &status_, how)) < 0 && errno == EINTR) {
  }
  ended_ = ended_ || found != 0;
  return ended_;
}

bool ChildProcess::has_ended() { return wait(WNOHANG); }

int ChildProcess::wait() {
  wait(0);
  return status_;
}

std::filesystem::path find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::string_view folders = path == nullptr ? "" : path;
  while (!folders.empty()) {
    const std::size_t end = std::min(folders.find(':'), folders.size());
    const std::filesystem::path found = std::filesystem::path(folders.substr(0, end)) / name;
    if (end > 0 && can_run(found)) return found;
    folders.remove_prefix(std::min(end + 1, folders.size()));
  }
  return {};
}

std::filesystem::path find_own_program(const std::string& name, const std::string& variable) {
  if (const std::filesystem::path path = OwnPrograms::instance().find(name); !path.empty()) {
    if (!can_run(path)) fail("{}: expected a program, found none at '{}'", name, path.string());
    return path;
  }
  const char* given = std::getenv(variable.c_str());
  if (given != nullptr && *given != '\0') {
    if (!can_run(given)) fail("{}: expected a program, found none at '{}'", variable, given);
    return given;
  }
  std::error_code code;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", code).parent_path();
  const std::filesystem::path installed = ADAMAS_INSTALLED_PROGRAMS;
  for (const auto& place : {folder / name, folder / ".." / "libexec" / name, installed / name}) {
    if (can_run(place)) return place;
  }
  fail("expected the program '{}' in {}, {} or {}, found none (the variable {} can name it)", name,
       folder.string(), (folder / "../libexec").lexically_normal().string(), installed.string(), variable);
}

void set_own_program(const std::string& name, const std::filesystem::path& path) {
  OwnPrograms::instance().set(name, path);
}

}  // namespace adamas::inline core
