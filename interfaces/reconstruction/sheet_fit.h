#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "adamas/geometry.h"

namespace adamas::interfaces {

/// A layer of even thickness between two parallel planes. Coordinates are those of a window of cells: cells
/// have sides of length 1, and the origin is the centre of the middle cell.
struct Slab {
  Vec3 normal;        ///< unit normal
  double offset = 0;  ///< the position of the layer's middle along the normal
  double thickness = 0;
  /// The standard deviation of the steps of fractions at its faces; 0 if these are sharp.
  double width = 0;

  /// Returns the part of the cell round a point that lies in the layer or, for a blurred layer, its fraction
  /// there.
  [[nodiscard]] double part_of_cell(const Vec3& centre) const;
  /// Returns the distance of a point from the layer's middle, positive on the normal's side.
  [[nodiscard]] double height(const Vec3& p) const { return dot(normal, p) - offset; }
};

/// Returns the length of a cell along a direction; `direction` is in cells, `size` is the cell's size.
inline double length_along(const Vec3& direction, const Vec3& size) {
  return 1 / norm(Vec3{direction.x / size.x, direction.y / size.y, direction.z / size.z});
}

/// The fractions of a thin material in a cube of cells round one cell.
struct SheetWindow {
  static constexpr int kReach = 2, kBlurredReach = 4;  ///< in cells; the second for blurred layers

  explicit SheetWindow(bool blurred)
      : reach(blurred ? kBlurredReach : kReach),
        places(&places_within(reach)),
        cells(places->size()),
        fraction(cells, 0),
        known(cells, 0) {}

  /// Returns the centres of the cells of a window, x fastest.
  static const std::vector<Vec3>& places_within(int reach);

  int reach;
  const std::vector<Vec3>* places;
  double noise = 0;             ///< standard deviation of the fractions' errors
  double radius = reach + 0.5;  ///< weights fall with the distance from the middle to 0 here
  std::size_t cells;
  std::vector<float> fraction;
  std::vector<char> known;  ///< whether the cell exists and holds no material that disturbs the fit

  [[nodiscard]] bool blurred() const { return reach == kBlurredReach; }
  [[nodiscard]] Vec3 place(std::size_t cell) const { return (*places)[cell]; }
};

/// Guesses the layer of the thin material near the window's middle from the mean and the covariance of its
/// fractions; returns none if they do not form a layer.
std::optional<Slab> guess_sheet(const SheetWindow& window);

/// Fits a layer to the window's fractions by least squares. The guess is the start and determines whether the
/// layer is blurred. Returns none if no layer fits well, or if it is so thick or so far away that the window
/// does not show both its sides. Blurred layers may be curved in the window. `off` is set to the root of the
/// remaining sum of squares relative to that of the fractions, also if the layer is too thick or too far
/// away.
std::optional<Slab> fit_sheet(SheetWindow& window, const Slab& guess, double& off);

}  // namespace adamas::interfaces
