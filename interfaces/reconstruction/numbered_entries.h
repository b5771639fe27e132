#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace adamas::interfaces {

/// A subset of the entries of SiteValues and their numbers in it, from 1; the number 0 stands for all others.
/// Arrays for few of many entries are indexed by these numbers.
class NumberedEntries {
 public:
  /// `count`: the count of all entries.
  explicit NumberedEntries(std::size_t count) : marks_(count / kBits + 1, 0), before_(marks_.size(), 0) {}

  /// Adds an entry; number_all() must follow before numbers are asked for.
  void add(std::size_t entry) { marks_[entry / kBits] |= std::uint64_t{1} << entry % kBits; }
  void number_all() {
    std::uint32_t sum = 1;
    for (std::size_t word = 0; word < marks_.size(); ++word) {
      before_[word] = sum;
      sum += static_cast<std::uint32_t>(std::popcount(marks_[word]));
    }
    size_ = sum;
  }
  /// Returns the count of numbers, 0 included.
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::uint32_t number(std::size_t entry) const {
    const std::uint64_t word = marks_[entry / kBits], mark = std::uint64_t{1} << entry % kBits;
    if ((word & mark) == 0) return 0;
    return before_[entry / kBits] + static_cast<std::uint32_t>(std::popcount(word & (mark - 1)));
  }

 private:
  static constexpr std::size_t kBits = 64;

  std::vector<std::uint64_t> marks_;
  std::vector<std::uint32_t> before_;  // by word: the number of its first entry
  std::size_t size_ = 1;
};

}  // namespace adamas::interfaces
