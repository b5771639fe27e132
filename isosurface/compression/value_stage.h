#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/lattice/lattice_point.h"
#include "isosurface/storage/page.h"

namespace adamas {

/// What is coded of a page at once: one number of each of its own points of a phase.
template <class Number>
struct ValueStage {
  static constexpr std::size_t kMost = 1536;

  /// Points that follow each other along i in steps of two.
  struct Segment {
    std::uint16_t place;  ///< of the first
    std::uint16_t count;
    /// Whether all points of the row may be given what is predicted, before those that are coded are known.
    bool whole_row;
  };

  /// The points that are coded.
  std::size_t size = 0;
  std::array<std::uint16_t, kMost> places, contexts;
  std::array<Number, kMost> predicted, bound;
  /// The points whose numbers are as predicted.
  std::size_t segment_count = 0;
  std::array<Segment, 192> segments;
  /// What is predicted of them, by place.
  typename Page<Number>::template Points<Number> sure;

  void clear() { size = segment_count = 0; }
};

/// The points of a phase whose coordinates are odd along the same axes.
struct ValueKind {
  LatticePoint odd;  ///< 1 along these axes, 0 along the others

  /// Calls with the first point of each row along i; the others of the row follow in steps of two.
  template <class Visit>
  void rows(const PageShape& shape, Visit visit) const {
    if (odd.i >= shape.count.i) return;
    for (std::int32_t k = odd.k; k < shape.count.k; k += 2) {
      for (std::int32_t j = odd.j; j < shape.count.j; j += 2) visit(LatticePoint{odd.i, j, k});
    }
  }

  /// Along how many axes a neighbour that matters may be on another page: before the page on edges, whose
  /// range comes from the samples round them, behind it on faces and in centres, whose children are there.
  [[nodiscard]] int missing(LatticePoint q, const PageShape& shape, int phase) const {
    int count = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (phase == 2) {
        count += odd[axis] == 0 && q[axis] == 0 ? 1 : 0;
      } else {
        count += odd[axis] == 1 && q[axis] == 15 && shape.count[axis] == 16 ? 1 : 0;
      }
    }
    return count;
  }
};

/// Among the rows of cubes along an axis, the first of those that have a coordinate: it and the next one have
/// an even one between them, and one alone has an odd one.
constexpr std::int32_t first_cube(std::int32_t x) { return (x + 1) / 2; }

/// How many kinds a phase has, and which.
constexpr int value_kind_count(int phase) { return phase == 0 ? 1 : 3; }
constexpr ValueKind value_kind(int phase, int number) {
  if (phase == 0) return {{1, 1, 1}};
  ValueKind kind{{phase == 1, phase == 1, phase == 1}};
  kind.odd[number] ^= 1;
  return kind;
}

}  // namespace adamas
