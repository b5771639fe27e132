#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace adamas::inline core {

/// Disjoint sets of numbers (union-find); the lowest member represents each set.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t i, std::uint32_t j) {
    if (parent_[i] == parent_[j]) return;
    i = find(i);
    j = find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }
  /// The representative of each member's set. The object is empty afterwards.
  [[nodiscard]] std::vector<std::uint32_t> roots() && {
    // Parents are lower than their children, so that theirs are known already.
    for (std::uint32_t& parent : parent_) parent = parent_[parent];
    return std::move(parent_);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace adamas::inline core
