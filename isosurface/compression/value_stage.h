#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/lattice/lattice_point.h"
#include "isosurface/compression/padded_grid.h"
#include "isosurface/compression/row_lanes.h"
#include "isosurface/storage/page.h"

namespace adamas {

/// What is coded of a page at once: one number of some of its own points of a phase.
struct ValueStage {
  static constexpr std::size_t kMost = 1536;

  std::size_t size = 0;
  /// PaddedGrid::place of each. One more than there may be, so that what is not kept can be written too.
  std::array<std::uint16_t, kMost + 1> places, contexts;
};

/// Calls visit(first, row count) with the first point of each row along i that has points of the phase; the
/// others of the row follow in steps of two. Rows of one kind follow each other.
template <class Visit>
void for_each_row(const PageShape& shape, int phase, Visit visit) {
  for (std::int32_t odd_k = 0; odd_k < 2; ++odd_k) {
    for (std::int32_t odd_j = 0; odd_j < 2; ++odd_j) {
      const std::int32_t odd_i = 3 - phase - odd_j - odd_k;
      if (odd_i < 0 || odd_i > 1 || odd_i >= shape.count.i) continue;
      for (std::int32_t k = odd_k; k < shape.count.k; k += 2) {
        for (std::int32_t j = odd_j; j < shape.count.j; j += 2) visit(LatticePoint{odd_i, j, k});
      }
    }
  }
}

/// How many points of a row there are, from its first one on.
inline std::int32_t row_count(const PageShape& shape, LatticePoint first) {
  return (shape.count.i - first.i + 1) / 2;
}

/// Copies the numbers of a phase's points.
template <class T>
[[gnu::always_inline]] inline void copy_points(const PageShape& shape, LatticePoint first,
                                               const PaddedGrid<T>& from, PaddedGrid<T>& to) {
  const LatticePoint row{0, first.j, first.k};
  if (shape.count.i == PageGrid::kSide) {
    copy_every_other(from.at(row), to.at(row), static_cast<std::size_t>(first.i));
  } else {
    const std::size_t place = PaddedGrid<T>::place(first);
    for (std::size_t n = 0; n < static_cast<std::size_t>(row_count(shape, first)); ++n)
      to[place + 2 * n] = from[place + 2 * n];
  }
}

/// The points of a phase, by PaddedGrid::place, and which of them have all that matters on their page.
class PhasePoints {
 public:
  /// Whether the errors of points are sure on the finest level, or the ranges, those of edges on that level
  /// alone.
  enum class Of : std::uint8_t { kErrors, kRanges };

  PhasePoints(const PageShape& shape, int phase, Of of) {
    for_each_row(shape, phase, [&](LatticePoint q) {
      for (; q.i < shape.count.i; q.i += 2) {
        bool is_sure = true;
        for (int axis = 0; axis < 3; ++axis) is_sure = is_sure && sure(q[axis], shape.count[axis], phase, of);
        const auto place = static_cast<std::uint16_t>(PaddedGrid<int>::place(q));
        all_[size_] = place;
        sure_[size_++] = is_sure;
        if (!is_sure) open_[open_size_++] = place;
      }
    });
  }

  [[nodiscard]] std::span<const std::uint16_t> all() const { return {all_.data(), size_}; }
  /// Of the points of all().
  [[nodiscard]] std::span<const bool> sure() const { return {sure_.data(), size_}; }
  /// Those that are not sure.
  [[nodiscard]] std::span<const std::uint16_t> open() const { return {open_.data(), open_size_}; }

 private:
  /// As far as a coordinate tells, where there are `count` of them.
  static bool sure(std::int32_t x, std::int32_t count, int phase, Of of) {
    const bool odd = (x & 1) != 0;
    // Cubes along both sides of edges and faces, and the children of these and of centres.
    if (of == Of::kErrors) return odd ? phase == 2 || x + 1 < count : x > 0 && x + 1 < count;
    // What is before the page round edges, whose range comes from the samples there; and what is behind it
    // round others, whose children are there.
    if (phase == 2) return odd || x > 0;
    return !odd || x < PageGrid::kSide - 1 || count < PageGrid::kSide;
  }

  std::size_t size_ = 0, open_size_ = 0;
  std::array<std::uint16_t, ValueStage::kMost> all_, open_;
  std::array<bool, ValueStage::kMost> sure_;
};

/// Of pages with all 16^3 points.
inline const PhasePoints& points_of_full_pages(int phase, PhasePoints::Of of) {
  static const std::vector<PhasePoints> kAll = [] {
    const PageShape full{{PageGrid::kSide, PageGrid::kSide, PageGrid::kSide}, false, 0};
    std::vector<PhasePoints> all;
    for (const auto each : {PhasePoints::Of::kErrors, PhasePoints::Of::kRanges}) {
      for (int n = 0; n < 3; ++n) all.emplace_back(full, n, each);
    }
    return all;
  }();
  return kAll[static_cast<std::size_t>(3 * static_cast<int>(of) + phase)];
}

/// Calls visit(points) with the points of a phase.
template <class Visit>
void with_points(const PageShape& shape, int phase, PhasePoints::Of of, Visit visit) {
  const bool is_full = shape.count == LatticePoint{PageGrid::kSide, PageGrid::kSide, PageGrid::kSide};
  if (!is_full) return visit(PhasePoints(shape, phase, of));
  visit(points_of_full_pages(phase, of));
}

}  // namespace adamas
