#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "core/io/file_handle.h"

namespace adamas::io {

/// Hands out bytes piece by piece, an empty piece at their end and ever after. A piece is good until the
/// next.
using ByteSupply = std::function<std::string_view()>;

/// The bytes of a text that outlives the supply.
ByteSupply supply_text(std::string_view text);
/// The bytes of a file from `begin` to its end.
ByteSupply supply_file(std::shared_ptr<const FileHandle> file, std::uint64_t begin);
/// Those of one supply, then those of another.
ByteSupply supply_both(ByteSupply first, ByteSupply second);
/// Those before the first `mark`.
ByteSupply supply_before(ByteSupply bytes, char mark);
/// What base64 text stands for; blanks in it are passed over, and '=' may stand within it where encoded parts
/// follow each other. Throws Error with `name` at any other character and at a group that is broken off.
ByteSupply supply_base64(ByteSupply text, std::string name);

/// Takes counted numbers of bytes from a supply.
class ByteTaker {
 public:
  explicit ByteTaker(ByteSupply supply) : supply_(std::move(supply)) {}

  /// At most `most` of the next bytes; none only at the end.
  std::string_view take(std::uint64_t most);
  /// Exactly `size` bytes; false where there are fewer.
  bool take_all(char* bytes, std::size_t size);
  /// A supply of the next `size` bytes, fewer at the end; the taker has to outlive it.
  ByteSupply part(std::uint64_t size);

 private:
  ByteSupply supply_;
  std::string_view piece_;
};

}  // namespace adamas::io
