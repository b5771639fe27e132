#include "core/io/decompression.h"

#include <bzlib.h>
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>
#include <vector>

#include "core/base/error.h"

namespace adamas::io {

namespace {

/// Gives a stream of zlib or bzip2 the next bytes: those of `piece`, else of the supply. Returns false if
/// there are no more.
template <class Stream>
bool hand_over(const ByteSupply& supply, std::string_view& piece, Stream& stream) {
  using Count = decltype(stream.avail_in);
  if (piece.empty()) piece = supply();
  const std::size_t step = std::min<std::size_t>(piece.size(), std::numeric_limits<Count>::max());
  stream.next_in = reinterpret_cast<decltype(stream.next_in)>(const_cast<char*>(piece.data()));
  stream.avail_in = static_cast<Count>(step);
  piece.remove_prefix(step);
  return step > 0;
}

constexpr char kGzip = '\x1f';

class Inflater {
 public:
  /// `raw`: whether the stream has no header.
  Inflater(const ByteSupply& compressed, bool raw)
      : supply_(compressed), raw_(raw), out_(std::size_t{1} << 18) {
    constexpr int kWindow = 15, kAnyHeader = 32;
    inflateInit2(&zip_, raw ? -kWindow : kWindow + kAnyHeader);
  }
  ~Inflater() { inflateEnd(&zip_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Returns false if the stream is corrupt or ends early.
  bool run(const ByteReceiver& receive) {
    if (!more_input()) return false;
    const bool gzip = !raw_ && *zip_.next_in == static_cast<Bytef>(kGzip);
    for (int state = Z_OK; state == Z_OK;) {
      if (zip_.avail_in == 0) more_input();
      zip_.next_out = reinterpret_cast<Bytef*>(out_.data());
      zip_.avail_out = static_cast<uInt>(out_.size());
      state = inflate(&zip_, Z_NO_FLUSH);
      const std::size_t made = out_.size() - zip_.avail_out;
      total_ += made;
      if (made > 0 && !receive({out_.data(), made})) return true;
      if (state == Z_STREAM_END) {
        if (!gzip || (zip_.avail_in == 0 && !more_input())) return true;
        if (*zip_.next_in != static_cast<Bytef>(kGzip)) return true;
        state = inflateReset(&zip_);
      } else if (state == Z_BUF_ERROR && (zip_.avail_in > 0 || more_input())) {
        state = Z_OK;
      }
    }
    return false;
  }

  [[nodiscard]] std::uint64_t total() const { return total_; }

 private:
  bool more_input() { return hand_over(supply_, piece_, zip_); }

  const ByteSupply& supply_;
  bool raw_;
  std::string_view piece_;
  std::vector<char> out_;
  z_stream zip_{};
  std::uint64_t total_ = 0;
};

class Bunzipper {
 public:
  explicit Bunzipper(const ByteSupply& compressed) : supply_(compressed), out_(std::size_t{1} << 18) {
    begin();
  }
  ~Bunzipper() { BZ2_bzDecompressEnd(&zip_); }
  Bunzipper(const Bunzipper&) = delete;
  Bunzipper& operator=(const Bunzipper&) = delete;

  /// Returns false if a stream is corrupt or ends early.
  bool run(const ByteReceiver& receive) {
    for (;;) {
      const bool fed = zip_.avail_in > 0 || more_input();
      zip_.next_out = out_.data();
      zip_.avail_out = static_cast<unsigned>(out_.size());
      const int state = BZ2_bzDecompress(&zip_);
      const std::size_t made = out_.size() - zip_.avail_out;
      total_ += made;
      if (made > 0 && !receive({out_.data(), made})) return true;
      if (state == BZ_MEM_ERROR) throw std::bad_alloc();
      if (state == BZ_STREAM_END) {
        if ((zip_.avail_in == 0 && !more_input()) || *zip_.next_in != 'B') return true;
        BZ2_bzDecompressEnd(&zip_);
        begin();
      } else if (state != BZ_OK || (!fed && made == 0)) {
        return false;
      }
    }
  }

  [[nodiscard]] std::uint64_t total() const { return total_; }

 private:
  void begin() {
    constexpr int kSilent = 0, kFast = 0;
    if (BZ2_bzDecompressInit(&zip_, kSilent, kFast) != BZ_OK) throw std::bad_alloc();
  }
  bool more_input() { return hand_over(supply_, piece_, zip_); }

  const ByteSupply& supply_;
  std::string_view piece_;
  std::vector<char> out_;
  bz_stream zip_{};
  std::uint64_t total_ = 0;
};

std::uint64_t inflate_all(Inflater inflater, const std::string& name, const ByteReceiver& receive) {
  if (!inflater.run(receive))
    fail("{}: expected whole compressed data, found corrupt or truncated ones", name);
  return inflater.total();
}

}  // namespace

std::uint64_t inflate_stream(const ByteSupply& compressed, const std::string& name,
                             const ByteReceiver& receive) {
  return inflate_all(Inflater(compressed, false), name, receive);
}

std::uint64_t inflate_raw_stream(const ByteSupply& compressed, std::uint32_t checksum,
                                 const std::string& name, const ByteReceiver& receive) {
  uLong found = crc32(0, nullptr, 0);
  bool whole = true;
  const auto take = [&](std::string_view piece) {
    found = crc32_z(found, reinterpret_cast<const Bytef*>(piece.data()), piece.size());
    whole = receive(piece);
    return whole;
  };
  const std::uint64_t total = inflate_all(Inflater(compressed, true), name, take);
  if (whole && found != checksum)
    fail("{}: expected bytes with the CRC-32 {:08x}, found {:08x}", name, checksum, found);
  return total;
}

std::uint64_t bunzip_stream(const ByteSupply& compressed, const std::string& name,
                            const ByteReceiver& receive) {
  Bunzipper bunzipper(compressed);
  if (!bunzipper.run(receive))
    fail("{}: expected whole data compressed by bzip2, found corrupt or truncated ones", name);
  return bunzipper.total();
}

}  // namespace adamas::io
