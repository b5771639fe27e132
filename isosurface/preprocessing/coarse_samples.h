#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/lattice/lattice_point.h"

namespace adamas {

/// The samples whose coordinates are multiples of 16, and those that stand for points beyond the data.
template <class Word>
class CoarseSamples {
 public:
  static constexpr int kBits = 4;

  explicit CoarseSamples(LatticePoint last)
      : last_(last),
        end_{(last.i + 15) >> kBits, (last.j + 15) >> kBits, (last.k + 15) >> kBits},
        words_((static_cast<std::size_t>(end_.i) + 1) * (static_cast<std::size_t>(end_.j) + 1) *
               (static_cast<std::size_t>(end_.k) + 1)) {}

  /// The planes that it takes samples from.
  [[nodiscard]] std::int32_t planes() const { return end_.k + 1; }
  [[nodiscard]] std::int32_t plane(std::int32_t n) const { return std::min(n << kBits, last_.k); }
  /// Takes those of plane(n).
  void take(std::int32_t n, const Word* samples) {
    const std::size_t row = static_cast<std::size_t>(last_.i) + 1;
    for (std::int32_t j = 0; j <= end_.j; ++j) {
      const Word* from = samples + row * static_cast<std::size_t>(std::min(j << kBits, last_.j));
      for (std::int32_t i = 0; i <= end_.i; ++i)
        words_[place({i, j, n})] = from[std::min(i << kBits, last_.i)];
    }
  }

  /// Coordinates are multiples of 16, and may lie anywhere beyond the data.
  [[nodiscard]] Word at(LatticePoint p) const {
    return words_[place(
        {std::min(p.i >> kBits, end_.i), std::min(p.j >> kBits, end_.j), std::min(p.k >> kBits, end_.k)})];
  }

 private:
  [[nodiscard]] std::size_t place(LatticePoint q) const {
    const auto row = static_cast<std::size_t>(end_.i) + 1, rows = static_cast<std::size_t>(end_.j) + 1;
    return static_cast<std::size_t>(q.i) +
           row * (static_cast<std::size_t>(q.j) + rows * static_cast<std::size_t>(q.k));
  }

  LatticePoint last_, end_;
  std::vector<Word> words_;
};

}  // namespace adamas
