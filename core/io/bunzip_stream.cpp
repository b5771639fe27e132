#include "core/io/bunzip_stream.h"

#include <bzlib.h>

#include <algorithm>
#include <limits>
#include <new>
#include <vector>

#include "core/base/error.h"

namespace adamas {

namespace {

class Bunzipper {
 public:
  explicit Bunzipper(const ByteSupply& compressed) : supply_(compressed), out_(std::size_t{1} << 18) {
    begin();
  }
  ~Bunzipper() { BZ2_bzDecompressEnd(&zip_); }
  Bunzipper(const Bunzipper&) = delete;
  Bunzipper& operator=(const Bunzipper&) = delete;

  /// False where a stream is corrupt or ends early.
  bool run(const std::function<void(std::string_view)>& receive) {
    for (;;) {
      const bool fed = zip_.avail_in > 0 || more_input();
      zip_.next_out = out_.data();
      zip_.avail_out = static_cast<unsigned>(out_.size());
      const int state = BZ2_bzDecompress(&zip_);
      const std::size_t made = out_.size() - zip_.avail_out;
      total_ += made;
      if (made > 0) receive({out_.data(), made});
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
  bool more_input() {
    if (piece_.empty()) piece_ = supply_();
    const std::size_t step = std::min<std::size_t>(piece_.size(), std::numeric_limits<unsigned>::max());
    zip_.next_in = const_cast<char*>(piece_.data());
    zip_.avail_in = static_cast<unsigned>(step);
    piece_.remove_prefix(step);
    return step > 0;
  }

  const ByteSupply& supply_;
  std::string_view piece_;
  std::vector<char> out_;
  bz_stream zip_{};
  std::uint64_t total_ = 0;
};

}  // namespace

std::uint64_t bunzip_stream(const ByteSupply& compressed, const std::string& name,
                            const std::function<void(std::string_view)>& receive) {
  Bunzipper bunzipper(compressed);
  if (!bunzipper.run(receive))
    fail("{}: expected whole data compressed by bzip2, found corrupt or truncated ones", name);
  return bunzipper.total();
}

}  // namespace adamas
