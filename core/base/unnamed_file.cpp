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
  errno = reason;
  return named;
}

std::filesystem::path temporary_folder() {
  std::error_code code;
  std::filesystem::path folder = std::filesystem::temp_directory_path(code);
  if (!code) return folder;
  // Those that the standard library looks at, in its order.
  for (const char* name : {"TMPDIR", "TMP", "TEMP", "TEMPDIR"}) {
    if (const char* value = std::getenv(name))
      fail("{}: expected a folder for temporary files, found '{}': {}", name, value, code.message());
  }
  fail("/tmp: expected a folder for temporary files (TMPDIR names another): {}", code.message());
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
