#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/grid_data.h"

namespace adamas::interfaces {

/// The cell of a site, divided into parts of the tetrahedra of the lattice round it (docs/method.md,
/// Interfaces from volume fractions). Lattice points are numbered by their offset from the site: the one at
/// (dx, dy, dz) has the number dx + 1 + 3 (dy + 1) + 9 (dz + 1).
struct SiteCell {
  static constexpr std::size_t kNeighbours = 27, kSelf = 13;

  /// A corner of parts. Its value is interpolated between at most four lattice points.
  struct Node {
    std::array<std::uint8_t, 4> points;
    std::array<double, 4> weights;
    [[nodiscard]] double interpolate(const std::array<double, kNeighbours>& values) const {
      return weights[0] * values[points[0]] + weights[1] * values[points[1]] +
             weights[2] * values[points[2]] + weights[3] * values[points[3]];
    }
  };
  struct Part {
    std::array<std::uint16_t, 4> nodes;
    double volume;  ///< relative to the cell's volume
  };
  std::vector<Node> nodes;
  std::vector<Part> parts;
  double volume = 0;  ///< the sum of the parts' volumes
};

/// The cells of all sites of a grid. Equal cells are stored once.
class SiteCells {
 public:
  explicit SiteCells(const RectilinearGrid& grid);

  /// Returns the cell of site (i, j, k); `scratch` holds it where the grid has too many different cells to
  /// keep them.
  const SiteCell& at(std::size_t i, std::size_t j, std::size_t k, SiteCell& scratch) const;

 private:
  /// One side of a cell along an axis. `reach`: the part of the interval between the site and the next
  /// lattice point that belongs to the cell. `length`: the interval's length relative to the cell's.
  struct Side {
    double reach, length;
    auto operator<=>(const Side&) const = default;
  };
  using Shape = std::array<Side, 2>;

  static Shape shape_at(const RectilinearGrid& grid, int axis, std::size_t i);
  static void make(const std::array<Shape, 3>& shapes, SiteCell& cell);

  std::array<std::vector<Shape>, 3> shapes_;            // the different shapes
  std::array<std::vector<std::uint32_t>, 3> shape_of_;  // indexed by the site along the axis
  // the cells of all combinations of shapes, if there are few
  std::vector<SiteCell> cells_;
};

}  // namespace adamas::interfaces
