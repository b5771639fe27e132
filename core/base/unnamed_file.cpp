#include "core/base/unnamed_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include "core/base/error.h"

namespace adamas::inline core {

int open_unnamed_file(const std::filesystem::path& folder) {
  const int unnamed = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (unnamed >= 0) return unnamed;
  // Some file systems cannot make files without names. Signals are blocked while
  // the file has a name, so that none of them ends this thread and leaves it behind.
  sigset_t all{}, before{};
  sigfillset(&all);
  ::pthread_sigmask(SIG_BLOCK, &all, &before);
  std::string pattern = (folder / "adamas-scratch-XXXXXX").string();
  const int named = ::mkostemp(pattern.data(), O_CLOEXEC);
  const int reason = errno;
  if (named >= 0) ::unlink(pattern.c_str());
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (named < 0)
    fail(
        "{}: expected a folder for temporary files that can be written (--scratch or TMPDIR names another): "
        "{}",
        folder.string(), std::strerror(reason));
  return named;
}

std::filesystem::path temporary_folder() {
  std::error_code code;
  std::filesystem::path folder = std::filesystem::temp_directory_path(code);
  if (!code) return folder;
  // The variables that the standard library looks at, in its order.
  for (const char* name : {"TMPDIR", "TMP", "TEMP", "TEMPDIR"}) {
    if (const char* value = std::getenv(name))
      fail("{}: expected a folder for temporary files, found '{}': {}", name, value, code.message());
  }
  fail("/tmp: expected a folder for temporary files (TMPDIR names another): {}", code.message());
}

ScratchFile::ScratchFile(std::filesystem::path folder)
    : folder_(folder.empty() ? temporary_folder() : std::move(folder)),
      descriptor_(open_unnamed_file(folder_)) {}

ScratchFile::~ScratchFile() { close(descriptor_); }

void ScratchFile::write(std::uint64_t at, std::span<const std::byte> bytes) {
  const std::uint64_t end = at + bytes.size();
  while (!bytes.empty()) {
    const ssize_t put = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0)
      fail_as(writing_failure(errno), "{}: cannot hold {} bytes of scratch data: {}", folder_.string(), end,
              std::strerror(errno));
    at += static_cast<std::uint64_t>(put);
    bytes = bytes.subspan(static_cast<std::size_t>(put));
  }
}

void ScratchFile::read(std::uint64_t at, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t got = pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail("{}: scratch data cannot be read: {}", folder_.string(), std::strerror(errno));
    at += static_cast<std::uint64_t>(got);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
}

MemoryFile::MemoryFile(const char* name) : descriptor_(::memfd_create(name, MFD_CLOEXEC)) {
  if (descriptor_ < 0)
    fail("no file in memory for what a separate program reads and writes: {}", std::strerror(errno));
}

MemoryFile::~MemoryFile() { ::close(descriptor_); }

void MemoryFile::fill(const std::vector<char>& bytes) const {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t size = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) fail("no memory for what a separate program reads: {}", std::strerror(errno));
    done += static_cast<std::size_t>(size);
  }
  ::lseek(descriptor_, 0, SEEK_SET);
}

std::vector<char> MemoryFile::content() const {
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

}  // namespace adamas::inline core
