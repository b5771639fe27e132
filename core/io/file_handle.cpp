#include "core/io/file_handle.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/unnamed_file.h"
#include "core/io/input_file.h"

namespace adamas::io {

FileHandle::FileHandle(int descriptor, std::string name, std::uint64_t size)
    : descriptor_(descriptor), name_(std::move(name)), size_(size) {}

FileHandle::~FileHandle() { ::close(descriptor_); }

std::shared_ptr<FileHandle> FileHandle::open(const std::filesystem::path& path) {
  const std::uint64_t size = check_input_file(path);
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail("{}: expected a readable file: {}", path.string(), std::strerror(errno));
  return std::shared_ptr<FileHandle>(new FileHandle(descriptor, path.string(), size));
}

std::shared_ptr<FileHandle> FileHandle::scratch(std::filesystem::path folder) {
  if (folder.empty()) folder = temporary_folder();
  const int descriptor = open_unnamed_file(folder);
  return std::shared_ptr<FileHandle>(new FileHandle(descriptor, folder.string(), 0));
}

std::shared_ptr<FileHandle> FileHandle::in_memory() {
  const int descriptor = ::memfd_create("adamas", MFD_CLOEXEC);
  if (descriptor < 0) fail("expected memory for unpacked samples, found none: {}", std::strerror(errno));
  return std::shared_ptr<FileHandle>(new FileHandle(descriptor, "memory", 0));
}

std::size_t FileHandle::read_some(std::uint64_t at, std::span<std::byte> bytes) const {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count =
        ::pread(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(at + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("{}: expected a readable file: {}", name_, std::strerror(errno));
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
}

void FileHandle::append(std::span<const std::byte> bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count =
        ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(size_));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      fail_as(writing_failure(count < 0 ? errno : ENOSPC),
              "{}: expected room for unpacked samples, found a full disk after {} bytes: {}", name_, size_,
              std::strerror(count < 0 ? errno : ENOSPC));
    }
    done += static_cast<std::size_t>(count);
    size_ += static_cast<std::uint64_t>(count);
  }
}

std::uint64_t FileHandle::behind_lines(std::uint64_t at, std::uint64_t lines, const std::string& name) const {
  constexpr std::size_t kPiece = std::size_t{1} << 18;
  std::vector<std::byte> piece(lines > 0 ? kPiece : 0);
  for (std::uint64_t left = lines; left > 0;) {
    const std::size_t count = read_some(at, piece);
    if (count == 0) fail("{}: expected {} lines to skip, found {}", name, lines, lines - left);
    for (std::size_t i = 0; i < count && left > 0; ++i, ++at) left -= piece[i] == std::byte{'\n'} ? 1 : 0;
  }
  return at;
}

}  // namespace adamas::io
