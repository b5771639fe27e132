#pragma once

#include <string_view>
#include <utility>

#include "core/io/byte_supply.h"

namespace adamas::test {

/// Supplies the bytes of a text, which must outlive the supply.
inline io::ByteSupply supply_text(std::string_view text) {
  return [text]() mutable { return std::exchange(text, std::string_view()); };
}

}  // namespace adamas::test
