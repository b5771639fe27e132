#pragma once

#include <cstddef>
#include <map>
#include <optional>

namespace adamas::viewer {

/// Allocates parts of a range of numbers, first fit.
class RangeAllocator {
 public:
  explicit RangeAllocator(std::size_t size) : size_(size) {
    if (size > 0) free_.emplace(0, size);
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t free_size() const {
    std::size_t sum = 0;
    for (const auto& [first, count] : free_) sum += count;
    return sum;
  }

  /// Takes `count` neighbouring free numbers. Returns the first of them, or nothing if there are not so many.
  std::optional<std::size_t> take(std::size_t count) {
    for (auto it = free_.begin(); it != free_.end(); ++it) {
      const auto [first, available] = *it;
      if (available < count) continue;
      free_.erase(it);
      if (available > count) free_.emplace(first + count, available - count);
      return first;
    }
    return std::nullopt;
  }

  /// Frees a part that take() returned.
  void give_back(std::size_t first, std::size_t count) {
    if (count == 0) return;
    const auto after = free_.lower_bound(first);
    if (after != free_.end() && after->first == first + count) {
      count += after->second;
      free_.erase(after);
    }
    const auto next = free_.lower_bound(first);
    if (next != free_.begin()) {
      const auto before = std::prev(next);
      if (before->first + before->second == first) {
        before->second += count;
        return;
      }
    }
    free_.emplace(first, count);
  }

 private:
  std::size_t size_;
  std::map<std::size_t, std::size_t> free_;  ///< free parts: the first number and the count of each
};

}  // namespace adamas::viewer
