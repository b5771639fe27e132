#include "core/io/output_stream.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <new>
#include <system_error>

#include "core/base/error.h"

namespace adamas::io {

OutputStream::OutputStream(const std::filesystem::path& path) : file_(path), buffer_(std::size_t{1} << 18) {
  stream_.rdbuf()->pubsetbuf(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  errno = 0;
  stream_.open(file_.temporary(), std::ios::binary | std::ios::trunc);
  if (!stream_) fail("{}: expected a writable file: {}", file_.path().string(), std::strerror(errno));
}

void OutputStream::check() {
  if (stream_) return;
  fail_as(writing_failure(errno), "{}: could not be written: {}", file_.path().string(),
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
    fail_as(ErrorKind::kSpace, "{}: could not be written: expected {} bytes, found {}", file_.path().string(),
            written_, code ? 0 : size);
  }
}

class GzipStream::State {
 public:
  explicit State(OutputStream& out) : out_(out) {
    constexpr int kLevel = 6, kWindow = 15, kGzip = 16, kMemory = 8;
    if (deflateInit2(&zip_, kLevel, Z_DEFLATED, kWindow + kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
      throw std::bad_alloc();
  }
  ~State() { deflateEnd(&zip_); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void put(const void* data, std::size_t size, int flush) {
    zip_.next_in = const_cast<Bytef*>(static_cast<const Bytef*>(data));
    do {
      const std::size_t step = std::min<std::size_t>(size, std::numeric_limits<uInt>::max());
      zip_.avail_in = static_cast<uInt>(step);
      size -= step;
      do {
        zip_.next_out = piece_.data();
        zip_.avail_out = static_cast<uInt>(piece_.size());
        deflate(&zip_, size == 0 ? flush : Z_NO_FLUSH);
        out_.write(piece_.data(), piece_.size() - zip_.avail_out);
      } while (zip_.avail_out == 0);
    } while (size > 0);
  }

 private:
  OutputStream& out_;
  z_stream zip_{};
  std::array<Bytef, std::size_t{1} << 16> piece_;
};

GzipStream::GzipStream(OutputStream& out) : state_(std::make_unique<State>(out)) {}
GzipStream::~GzipStream() = default;

void GzipStream::write(const void* data, std::size_t size) { state_->put(data, size, Z_NO_FLUSH); }
void GzipStream::finish() { state_->put(nullptr, 0, Z_FINISH); }

}  // namespace adamas::io
