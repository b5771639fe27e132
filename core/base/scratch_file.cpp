#include "core/base/scratch_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/base/error.h"
#include "core/base/unnamed_file.h"

namespace adamas::inline core {

ScratchFile::ScratchFile(std::filesystem::path folder)
    : folder_(folder.empty() ? temporary_folder() : std::move(folder)),
      descriptor_(open_unnamed_file(folder_)) {
  if (descriptor_ < 0)
    fail(
        "{}: expected a folder for temporary files that can be written (--scratch or TMPDIR names another): "
        "{}",
        folder_.string(), std::strerror(errno));
}

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

}  // namespace adamas::inline core
