#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "core/io/file_handle.h"

namespace adamas::io {

/// Returns the next piece of some bytes, and an empty piece at their end and from then on. A piece is valid
/// until the next one.
using ByteSupply = std::function<std::string_view()>;

/// Supplies the bytes of a file from `begin` to its end.
ByteSupply supply_file(std::shared_ptr<const FileHandle> file, std::uint64_t begin);
/// Supplies the bytes of one supply, followed by those of another.
ByteSupply supply_both(ByteSupply first, ByteSupply second);
/// Supplies the bytes before the first `mark`.
ByteSupply supply_before(ByteSupply bytes, char mark);
/// Supplies the bytes that a base64 text stands for. Blanks in it are skipped, and '=' may stand within it
/// where encoded parts follow each other. Throws Error with `name` at any other character and at an
/// incomplete group.
ByteSupply supply_base64(ByteSupply text, std::string name);

/// Takes counted numbers of bytes from a supply.
class ByteTaker {
 public:
  explicit ByteTaker(ByteSupply supply) : supply_(std::move(supply)) {}

  /// Takes at most `most` of the next bytes; empty only at the end.
  std::string_view take(std::uint64_t most);
  /// Takes exactly `size` bytes; returns false where there are fewer.
  bool take_all(char* bytes, std::size_t size);
  /// Makes a supply of the next `size` bytes, fewer at the end. The taker must outlive it.
  ByteSupply part(std::uint64_t size);

 private:
  ByteSupply supply_;
  std::string_view piece_;
};

}  // namespace adamas::io
