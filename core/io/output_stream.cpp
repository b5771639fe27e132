#include "core/io/output_stream.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include "core/base/error.h"

namespace adamas {

OutputStream::OutputStream(const std::filesystem::path& path) : file_(path), buffer_(std::size_t{1} << 18) {
  stream_.rdbuf()->pubsetbuf(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  errno = 0;
  stream_.open(file_.temporary(), std::ios::binary | std::ios::trunc);
  if (!stream_) fail("{}: expected a writable file: {}", file_.path().string(), std::strerror(errno));
}

void OutputStream::check() {
  if (stream_) return;
  fail("{}: could not be written: {}", file_.path().string(),
       errno != 0 ? std::strerror(errno) : "short write");
}

void OutputStream::write(const void* data, std::size_t size) {
  errno = 0;
  stream_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  check();
  written_ += size;
}

void OutputStream::close() {
  errno = 0;
  stream_.close();
  check();
  std::error_code code;
  const auto size = std::filesystem::file_size(file_.temporary(), code);
  if (code || size != written_) {
    fail("{}: could not be written: expected {} bytes, found {}", file_.path().string(), written_,
         code ? 0 : size);
  }
}

}  // namespace adamas
