#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/geometry/vec3.h"

namespace adamas::interfaces {

/// A layer of even thickness between two parallel planes, in the coordinates of a window of cells: cells have
/// sides of 1, and the middle one's centre is the origin.
struct Slab {
  Vec3 normal;        ///< unit
  double offset = 0;  ///< of the layer's middle along the normal
  double thickness = 0;
  double width = 0;  ///< standard deviation of the steps of fractions at its faces; 0 where these are sharp

  /// The part of the cell round a point that lies in the layer or, of a blurred one, its fraction there.
  [[nodiscard]] double part_of_cell(const Vec3& centre) const;
  /// The distance of a point from the layer's middle, positive on the normal's side.
  [[nodiscard]] double height(const Vec3& p) const { return dot(normal, p) - offset; }
};

/// The fractions of a thin material in the cells round one.
struct SheetWindow {
  static constexpr int kReach = 2, kBlurredReach = 4;  ///< in cells, of sharp layers and of blurred ones

  explicit SheetWindow(bool blurred)
      : reach(blurred ? kBlurredReach : kReach),
        side(2 * reach + 1),
        cells(static_cast<std::size_t>(side * side * side)),
        fraction(cells, 0),
        known(cells, 0) {}

  int reach, side;
  double noise = 0;             ///< standard deviation of the fractions' errors
  double radius = reach + 0.5;  ///< cells have less weight the farther they are away, and none from here on
  std::size_t cells;
  std::vector<float> fraction;
  std::vector<char> known;  ///< whether there is such a cell, with nothing else in it that disturbs

  [[nodiscard]] bool blurred() const { return reach == kBlurredReach; }
  [[nodiscard]] Vec3 place(std::size_t cell) const {
    const auto c = static_cast<int>(cell);
    return {static_cast<double>(c % side - reach), static_cast<double>(c / side % side - reach),
            static_cast<double>(c / (side * side) - reach)};
  }
};

/// The middle of the thin material near the window's and the normal of the layer that it seems to be; nothing
/// where it is no layer.
std::optional<Slab> guess_sheet(const SheetWindow& window);

/// The layer that holds the window's fractions best, by least squares from a guess on, which says whether it
/// is blurred; nothing where none does well, or where it is so thick or so far away that the window does not
/// show both its sides. Blurred layers may be curved in the window. `off`: set to the root of the sum of
/// squares that is left, as a part of that of the fractions, also where the layer is thick or far away.
std::optional<Slab> fit_sheet(SheetWindow& window, const Slab& guess, double& off);

}  // namespace adamas::interfaces
