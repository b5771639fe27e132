#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/geometry/vec3.h"

namespace adamas {

/// A layer of even thickness between two parallel planes, in the coordinates of a window of cells: cells have
/// sides of 1, and the middle one's centre is the origin.
struct Slab {
  Vec3 normal;        ///< unit
  double offset = 0;  ///< of the layer's middle along the normal
  double thickness = 0;

  /// The part of the cell round a point that lies in the layer.
  [[nodiscard]] double part_of_cell(const Vec3& centre) const;
  /// The distance of a point from the layer's middle, positive on the normal's side.
  [[nodiscard]] double height(const Vec3& p) const { return dot(normal, p) - offset; }
};

/// The fractions of a thin material in the cells round one.
struct SheetWindow {
  static constexpr int kReach = 2, kSide = 2 * kReach + 1;
  static constexpr std::size_t kCells = kSide * kSide * kSide;

  std::array<float, kCells> fraction{};
  std::array<char, kCells> known{};  ///< whether there is such a cell, with nothing else in it that disturbs

  static Vec3 place(std::size_t cell) {
    const auto c = static_cast<int>(cell);
    return {static_cast<double>(c % kSide - kReach), static_cast<double>(c / kSide % kSide - kReach),
            static_cast<double>(c / (kSide * kSide) - kReach)};
  }
};

/// The middle of the thin material near the window's and the normal of the layer that it seems to be; nothing
/// where it is no layer.
std::optional<Slab> guess_sheet(const SheetWindow& window);

/// The layer that holds the window's fractions best, by least squares from a guess on; nothing where none
/// does well, or where it is so thick or so far away that the window does not show both its sides.
std::optional<Slab> fit_sheet(const SheetWindow& window, const Slab& guess);

}  // namespace adamas
