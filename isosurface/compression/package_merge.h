#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace adamas {

/// Lengths of the codewords of a prefix code without a word longer than `limit` bits that has the least sum
/// of count times length (Larmore and Hirschberg 1990, the package-merge algorithm). A symbol that does not
/// occur gets length 0, and one that alone occurs gets length 1. There are at most 2^limit symbols that
/// occur, 1 <= limit <= 32, and the counts add up to less than 2^58. Of two symbols that
/// occur equally often the later one never has the longer word, so the same counts give the same lengths.
[[nodiscard]] std::vector<std::uint8_t> package_merge(std::span<const std::uint64_t> counts, int limit);

}  // namespace adamas
