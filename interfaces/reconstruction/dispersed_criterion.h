#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/data/multi_material_data.h"

namespace adamas::interfaces {

/// What tells dispersed fractions, on grids and on meshes of any cells (docs/blurred_fractions.md, Dispersed
/// volume): a material is dispersed in a cell that holds little of it if no cell within reach holds more than
/// little, and if most of the cells near it hold about as much.
struct DispersedCriterion {
  /// Less than this is little.
  static constexpr float kLittle = 0.25f;
  /// Cells are near up to this many cells away.
  static constexpr std::size_t kNear = 2;

  /// Returns the reach in cells. `widest`: the greatest width of the material's steps where cells hold little
  /// of it, in cells.
  static int reach(double widest) {
    constexpr int kReach = 4, kFarthestReach = 10;
    return std::min(kReach + static_cast<int>(std::ceil(widest)), kFarthestReach);
  }
  /// Returns whether neither of two fractions is more than kAlike times the other.
  static bool is_alike(float a, float b) {
    constexpr float kAlike = 3;
    return a * kAlike >= b && a <= b * kAlike;
  }
  /// Returns whether these are most of the cells: more than layers would cut.
  static bool is_most(std::size_t alike, std::size_t cells) {
    constexpr double kMost = 0.55;
    return static_cast<double>(alike) >= kMost * static_cast<double>(cells);
  }
};

/// Scales the fractions of a cell's entries that are left so that their sum is 1. Returns whether one is left
/// alone.
template <class Entry>
bool give_to_others(std::span<Entry> entries) {
  float sum = 0;
  int left = 0;
  for (const Entry& entry : entries) {
    sum += entry.fraction;
    left += entry.fraction > 0 ? 1 : 0;
  }
  for (Entry& entry : entries) {
    if (entry.fraction > 0)
      entry.fraction = left == 1 ? 1 : std::min(entry.fraction / sum, 1 - kFractionTrace);
  }
  return left == 1;
}

/// Returns whether a cell holds another material than this one, to which it could be given.
template <class Entries, class Number>
bool holds_another(const Entries& entries, Number material) {
  return std::ranges::any_of(
      entries, [&](const auto& other) { return other.material != material && other.fraction > 0; });
}

}  // namespace adamas::interfaces
