#include "core/io/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <new>

#include "core/base/error.h"
#include "core/base/stopping_signals.h"

namespace adamas {

namespace {

constexpr std::size_t kFrame = std::size_t{1} << 20;
constexpr char kData = 'd', kEnd = 'e', kError = 'x';

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
#else
constexpr bool kSanitized = false;
#endif

bool write_all(int descriptor, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t done = ::write(descriptor, bytes, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes += done;
    size -= static_cast<std::size_t>(done);
  }
  return true;
}

bool read_all(int descriptor, void* data, std::size_t size) {
  auto* bytes = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t done = ::read(descriptor, bytes, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes += done;
    size -= static_cast<std::size_t>(done);
  }
  return true;
}

struct Truncated {};

void limit(int resource, rlim_t value) {
  rlimit current{};
  ::getrlimit(resource, &current);
  if (current.rlim_max != RLIM_INFINITY) value = std::min(value, current.rlim_max);
  current.rlim_cur = value;
  ::setrlimit(static_cast<__rlimit_resource>(resource), &current);
}

/// Address space already mapped, in bytes.
rlim_t mapped_bytes() {
  const int descriptor = ::open("/proc/self/statm", O_RDONLY);
  std::array<char, 64> text{};
  if (descriptor < 0) return 0;
  const ssize_t size = ::read(descriptor, text.data(), text.size() - 1);
  ::close(descriptor);
  const auto page = static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
  return size > 0 ? std::strtoull(text.data(), nullptr, 10) * page : 0;
}

/// What is ignored stays ignored.
void let_signals_stop() {
  for (const int number : kStoppingSignals) {
    if (!is_ignored(number)) ::signal(number, SIG_DFL);
  }
}

void confine(pid_t parent, std::size_t input_bytes) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  for (const int number : {SIGALRM, SIGPIPE}) ::signal(number, SIG_DFL);
  let_signals_stop();
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (int stream = 0; stream < 3; ++stream) ::dup2(nowhere, stream);
  limit(RLIMIT_CORE, 0);
  if (!kSanitized) {
    const auto memory =
        static_cast<rlim_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
    limit(RLIMIT_AS, mapped_bytes() + memory);
  }
  ::alarm(static_cast<unsigned>(std::min<std::size_t>(20 + input_bytes / 1'000'000, 86'400)));
}

[[noreturn]] void run_child(const std::string& name, pid_t parent, int descriptor, std::size_t input_bytes,
                            const std::function<void(ByteSink&)>& produce) {
  confine(parent, input_bytes);
  ByteSink sink(descriptor);
  try {
    produce(sink);
    sink.finish();
  } catch (const Error& error) {
    sink.finish_with_error(error.what());
  } catch (const std::bad_alloc&) {
    sink.finish_with_error(name + ": expected data that fit into memory, found more");
  } catch (const std::exception& error) {
    sink.finish_with_error(name + ": could not be read: " + error.what());
  } catch (...) {
    sink.finish_with_error(name + ": could not be read");
  }
  ::_exit(0);
}

[[noreturn]] void fail_stopped(const std::string& name, int status) {
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    const auto& stopping = kStoppingSignals;
    if (std::find(stopping.begin(), stopping.end(), number) != stopping.end()) throw Cancelled();
    if (number == SIGALRM) fail("{}: expected a readable file, found none within the time limit", name);
    fail("{}: expected a readable file, found a corrupt one (its reader ended by signal {}, {})", name,
         number, ::strsignal(number));
  }
  fail("{}: expected a readable file, found a corrupt one (its reader ended with status {})", name,
       WEXITSTATUS(status));
}

}  // namespace

void ByteSink::write(const void* data, std::size_t size) {
  if (size >= kFrame) {
    flush();
    const auto* bytes = static_cast<const char*>(data);
    for (std::size_t done = 0; done < size; done += kFrame) {
      send(kData, bytes + done, std::min(kFrame, size - done));
    }
    return;
  }
  const std::size_t old = buffer_.size();
  buffer_.resize(old + size);
  if (size > 0) std::memcpy(buffer_.data() + old, data, size);
  if (buffer_.size() >= kFrame) flush();
}

void ByteSink::put(const std::string& text) {
  put(static_cast<std::uint64_t>(text.size()));
  write(text.data(), text.size());
}

void ByteSink::flush() {
  for (std::size_t done = 0; done < buffer_.size(); done += kFrame) {
    send(kData, buffer_.data() + done, std::min(kFrame, buffer_.size() - done));
  }
  buffer_.clear();
}

void ByteSink::send(char kind, const void* data, std::size_t size) {
  const auto length = static_cast<std::uint32_t>(size);
  const bool whole = write_all(descriptor_, &kind, 1) && write_all(descriptor_, &length, sizeof(length)) &&
                     write_all(descriptor_, data, size);
  if (!whole) ::_exit(1);  // the parent is not listening any more
}

void ByteSink::finish() {
  flush();
  send(kEnd, nullptr, 0);
}

void ByteSink::finish_with_error(const std::string& message) {
  buffer_.clear();
  send(kError, message.data(), std::min(message.size(), kFrame));
}

bool ByteSource::next_frame() {
  char kind = 0;
  std::uint32_t length = 0;
  if (!read_all(descriptor_, &kind, 1) || !read_all(descriptor_, &length, sizeof(length)) ||
      length > kFrame) {
    throw Truncated();
  }
  frame_.resize(length);
  position_ = 0;
  if (!read_all(descriptor_, frame_.data(), length)) throw Truncated();
  if (kind == kError) throw Error(std::string(frame_.begin(), frame_.end()));
  return kind != kEnd;
}

void ByteSource::read(void* data, std::size_t size) {
  auto* bytes = static_cast<char*>(data);
  while (size > 0) {
    while (position_ == frame_.size()) {
      if (!next_frame()) throw Truncated();
    }
    const std::size_t step = std::min(size, frame_.size() - position_);
    std::memcpy(bytes, frame_.data() + position_, step);
    position_ += step;
    bytes += step;
    size -= step;
  }
}

std::string ByteSource::get_string() {
  const std::vector<char> text = get_vector<char>();
  return {text.begin(), text.end()};
}

void ByteSource::expect_end() {
  if (position_ != frame_.size() || next_frame()) throw Truncated();
}

void read_in_child(const std::string& name, std::size_t input_bytes,
                   const std::function<void(ByteSink&)>& produce,
                   const std::function<void(ByteSource&)>& consume) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    fail("{}: no pipe for its reader: {}", name, std::strerror(errno));
  ::fcntl(ends[1], F_SETPIPE_SZ, static_cast<int>(kFrame));
  const pid_t self = ::getpid(), child = ::fork();
  if (child < 0) {
    const int reason = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    fail("{}: no process for its reader: {}", name, std::strerror(reason));
  }
  if (child == 0) {
    ::close(ends[0]);
    run_child(name, self, ends[1], input_bytes, produce);
  }
  ::close(ends[1]);
  const auto end_child = [&] {
    ::close(ends[0]);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
  };
  try {
    ByteSource source(ends[0]);
    consume(source);
    source.expect_end();
  } catch (const Truncated&) {
    fail_stopped(name, end_child());
  } catch (...) {
    end_child();
    throw;
  }
  end_child();
}

}  // namespace adamas
