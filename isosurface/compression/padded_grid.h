#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/lattice/lattice_point.h"
#include "isosurface/storage/page_grid.h"

namespace adamas {

/// Numbers of a page's points and of those one step round them, so that neighbours need no borders:
/// coordinates from -1 to 16, i running fastest.
template <class T>
class PaddedGrid {
 public:
  static constexpr std::ptrdiff_t kSide = 18;

  void fill(T value) { numbers_.fill(value); }

  [[nodiscard]] const T* at(LatticePoint q) const { return numbers_.data() + index(q); }
  [[nodiscard]] T* at(LatticePoint q) { return numbers_.data() + index(q); }
  /// Of a place of a page.
  [[nodiscard]] T& at_place(std::size_t place) { return numbers_[kPlaces[place]]; }
  /// Of a step.
  static constexpr std::ptrdiff_t offset(LatticePoint d) { return d.i + kSide * (d.j + kSide * d.k); }

 private:
  static constexpr std::size_t index(LatticePoint q) {
    return static_cast<std::size_t>(offset({q.i + 1, q.j + 1, q.k + 1}));
  }

  static constexpr auto kPlaces = [] {
    std::array<std::uint16_t, PageGrid::kPoints> places{};
    for (std::int32_t n = 0; n < 4096; ++n) {
      const LatticePoint q{n & 15, n >> 4 & 15, n >> 8};
      places[static_cast<std::size_t>(n)] = static_cast<std::uint16_t>(offset({q.i + 1, q.j + 1, q.k + 1}));
    }
    return places;
  }();

  std::array<T, kSide * kSide * kSide> numbers_;
};

}  // namespace adamas
