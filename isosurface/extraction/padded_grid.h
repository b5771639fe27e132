#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/lattice/lattice_point.h"

namespace adamas {

/// Numbers of a page's points and of those one step round them, so that neighbours need no borders:
/// coordinates from -1 to 16, i running fastest.
template <class T>
class PaddedGrid {
 public:
  static constexpr std::ptrdiff_t kSide = 18;
  static constexpr std::size_t kPoints = kSide * kSide * kSide;

  void fill(T value) { numbers_.fill(value); }

  [[nodiscard]] const T* at(LatticePoint q) const { return numbers_.data() + place(q); }
  [[nodiscard]] T* at(LatticePoint q) { return numbers_.data() + place(q); }
  /// Of any grid, by the place of a point.
  static constexpr std::size_t place(LatticePoint q) {
    return static_cast<std::size_t>(offset({q.i + 1, q.j + 1, q.k + 1}));
  }
  [[nodiscard]] T operator[](std::size_t place) const { return numbers_[place]; }
  [[nodiscard]] T& operator[](std::size_t place) { return numbers_[place]; }
  /// Of a step.
  static constexpr std::ptrdiff_t offset(LatticePoint d) { return d.i + kSide * (d.j + kSide * d.k); }

 private:
  std::array<T, kPoints> numbers_;
};

}  // namespace adamas
