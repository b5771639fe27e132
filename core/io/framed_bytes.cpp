#include "core/io/framed_bytes.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/base/error.h"

namespace adamas::io {

namespace {

constexpr char kData = 'd', kEnd = 'e', kError = 'x';

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

}  // namespace

void ByteSink::write(const void* data, std::size_t size) {
  if (size >= kFrameBytes) {
    flush();
    const auto* bytes = static_cast<const char*>(data);
    for (std::size_t done = 0; done < size; done += kFrameBytes) {
      send(kData, bytes + done, std::min(kFrameBytes, size - done));
    }
    return;
  }
  const std::size_t old = buffer_.size();
  buffer_.resize(old + size);
  if (size > 0) std::memcpy(buffer_.data() + old, data, size);
  if (buffer_.size() >= kFrameBytes) flush();
}

void ByteSink::flush() {
  for (std::size_t done = 0; done < buffer_.size(); done += kFrameBytes) {
    send(kData, buffer_.data() + done, std::min(kFrameBytes, buffer_.size() - done));
  }
  buffer_.clear();
}

void ByteSink::send(char kind, const void* data, std::size_t size) {
  const auto length = static_cast<std::uint32_t>(size);
  const bool whole = write_all(descriptor_, &kind, 1) && write_all(descriptor_, &length, sizeof(length)) &&
                     write_all(descriptor_, data, size);
  if (!whole) fail("a separate program does not take what is sent to it: {}", std::strerror(errno));
}

void ByteSink::finish() {
  flush();
  send(kEnd, nullptr, 0);
}

void ByteSink::finish_with_error(const std::string& message) {
  buffer_.clear();
  send(kError, message.data(), std::min(message.size(), kFrameBytes));
}

bool ByteSource::next_frame() {
  char kind = 0;
  std::uint32_t length = 0;
  if (!read_all(descriptor_, &kind, 1) || !read_all(descriptor_, &length, sizeof(length)) ||
      length > kFrameBytes) {
    throw TruncatedStream();
  }
  frame_.resize(length);
  position_ = 0;
  if (!read_all(descriptor_, frame_.data(), length)) throw TruncatedStream();
  if (kind == kError) throw Error(std::string(frame_.begin(), frame_.end()));
  return kind != kEnd;
}

void ByteSource::read(void* data, std::size_t size) {
  auto* bytes = static_cast<char*>(data);
  while (size > 0) {
    while (position_ == frame_.size()) {
      if (!next_frame()) throw TruncatedStream();
    }
    const std::size_t step = std::min(size, frame_.size() - position_);
    std::memcpy(bytes, frame_.data() + position_, step);
    position_ += step;
    bytes += step;
    size -= step;
  }
}

void ByteSource::expect_end() {
  if (position_ != frame_.size() || next_frame()) throw TruncatedStream();
}

}  // namespace adamas::io
