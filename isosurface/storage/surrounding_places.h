#pragma once

// Where the places of Surroundings lie in pages of the next coarser LOD; page_cache.cpp alone includes this.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "isosurface/volume/page.h"

namespace adamas::isosurface {

inline constexpr std::int32_t kSurroundingSide = Surroundings<std::uint8_t>::kSide;

/// Where along an axis the places of Surroundings lie in the pages of the next coarser LOD.
struct AxisPlaces {
  std::array<std::int32_t, 2> blocks{};  ///< the coordinates of these pages
  int block_count = 0;
  std::array<std::uint8_t, kSurroundingSide> place{};  ///< of each place of Surroundings that in its page
  /// The places that lie in one page: the first, how many they are, and whether they follow each other there.
  struct Run {
    std::size_t first = 0, count = 0;
    bool is_run = true;
  };
  std::array<Run, 2> runs{};

  /// For the places from `first` to `last`.
  AxisPlaces(std::int32_t block, std::int32_t extent, std::int32_t first, std::int32_t last) {
    for (std::int32_t c = first; c <= last; ++c) {
      const std::int32_t at = std::clamp(8 * block + c - 1, 0, extent);
      const std::int32_t parent = at / PageGrid::kSide;
      if (block_count == 0 || blocks[static_cast<std::size_t>(block_count - 1)] != parent)
        blocks[static_cast<std::size_t>(block_count++)] = parent;
      place[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(at % PageGrid::kSide);
      Run& run = runs[static_cast<std::size_t>(block_count - 1)];
      if (run.count == 0) run.first = static_cast<std::size_t>(c);
      run.is_run = run.is_run && place[static_cast<std::size_t>(c)] == place[run.first] + run.count;
      ++run.count;
    }
  }
};

/// The same along all axes.
struct BoxPlaces {
  AxisPlaces x, y, z;

  BoxPlaces(LatticePoint block, LatticePoint extent, std::int32_t first, std::int32_t last)
      : x(block.i, extent.i, first, last),
        y(block.j, extent.j, first, last),
        z(block.k, extent.k, first, last) {}
};

/// The part of Surroundings that one page of the next coarser LOD has.
struct SurroundingPart {
  const BoxPlaces& places;
  std::array<int, 3> blocks;  ///< by axis, which of AxisPlaces::blocks

  [[nodiscard]] AxisPlaces::Run run(const AxisPlaces& axis, std::size_t n) const {
    return axis.runs[static_cast<std::size_t>(blocks[n])];
  }
};

/// Copies the numbers of a part whose rows are N points side by side; with N = 0 those of any part, one by
/// one.
template <std::size_t N, class T>
void copy_part(const SurroundingPart& part, const PagePoints<T>& from,
               std::array<T, kSurroundingSide * kSurroundingSide * kSurroundingSide>& to) {
  const auto& [x, y, z] = part.places;
  const AxisPlaces::Run xs = part.run(x, 0), ys = part.run(y, 1), zs = part.run(z, 2);
  for (std::size_t k = zs.first; k < zs.first + zs.count; ++k) {
    for (std::size_t j = ys.first; j < ys.first + ys.count; ++j) {
      const T* row = from.data() + PageGrid::kSide * (y.place[j] + std::size_t{PageGrid::kSide} * z.place[k]);
      T* at = to.data() + kSurroundingSide * (j + kSurroundingSide * k);
      if constexpr (N > 0) {
        std::copy_n(row + x.place[xs.first], N, at + xs.first);
      } else {
        for (std::size_t c = xs.first; c < xs.first + xs.count; ++c) at[c] = row[x.place[c]];
      }
    }
  }
}

template <class T>
void copy_part(const SurroundingPart& part, const PagePoints<T>& from,
               std::array<T, kSurroundingSide * kSurroundingSide * kSurroundingSide>& to) {
  // Away from the data's ends rows have one of these numbers of points, which lie side by side.
  const AxisPlaces::Run xs = part.run(part.places.x, 0);
  if (xs.is_run && xs.count == 1) return copy_part<1>(part, from, to);
  if (xs.is_run && xs.count == 2) return copy_part<2>(part, from, to);
  if (xs.is_run && xs.count == 8) return copy_part<8>(part, from, to);
  if (xs.is_run && xs.count == 9) return copy_part<9>(part, from, to);
  if (xs.is_run && xs.count == 10) return copy_part<10>(part, from, to);
  copy_part<0>(part, from, to);
}

}  // namespace adamas::isosurface
