#include "core/io/inflate_stream.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "core/base/error.h"

namespace adamas {

namespace {

struct Inflater {
  z_stream zip{};
  Inflater() { inflateInit2(&zip, 15 + 32); }
  ~Inflater() { inflateEnd(&zip); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
};

}  // namespace

std::size_t inflate_stream(std::string_view compressed, const std::string& name,
                           const std::function<void(std::string_view)>& receive) {
  Inflater inflater;
  z_stream& zip = inflater.zip;
  std::vector<char> out(std::size_t{1} << 18);
  std::size_t total = 0;
  int state = Z_OK;
  while (state == Z_OK) {
    if (zip.avail_in == 0) {
      const std::size_t step = std::min<std::size_t>(compressed.size(), std::numeric_limits<uInt>::max());
      zip.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));
      zip.avail_in = static_cast<uInt>(step);
      compressed.remove_prefix(step);
    }
    zip.next_out = reinterpret_cast<Bytef*>(out.data());
    zip.avail_out = static_cast<uInt>(out.size());
    state = inflate(&zip, Z_NO_FLUSH);
    const std::size_t made = out.size() - zip.avail_out;
    total += made;
    if (made > 0) receive({out.data(), made});
    // No progress without input: the stream ends early.
    if (state == Z_OK && made == 0 && zip.avail_in == 0 && compressed.empty()) break;
  }
  if (state != Z_STREAM_END)
    fail("{}: expected whole compressed data, found corrupt or truncated ones", name);
  return total;
}

}  // namespace adamas
