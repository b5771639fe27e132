#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace adamas::datasets {

/// Ripples of an interface across a tube of cells: a sum of cosines of one amplitude and random phases that
/// is periodic, kFewestWaves to kMostWaves of them along the greater width. Waves of fewer than four cells
/// are left out; all others have the same phases whatever the number of cells.
class Ripples {
 public:
  static constexpr double kFewestWaves = 2, kMostWaves = 6;

  /// `size` is the size of a cell, `height` the root mean square of the ripples.
  Ripples(const std::array<std::size_t, 3>& cells, double size, std::uint64_t seed, double height);

  /// The part of a cell of column (i, j) that lies above the ripples; `low` is the height of its bottom above
  /// their mean, in cells.
  [[nodiscard]] double part_above(std::size_t i, std::size_t j, double low) const;

 private:
  struct Wave {
    double along_x = 0, along_y = 0;  ///< waves per width, whole numbers
    double phase = 0;
  };
  /// The number of points along each side of a column at which the ripples are computed.
  static constexpr std::size_t kPoints = 4;

  void find_waves(const std::array<std::size_t, 3>& cells, std::uint64_t seed);

  std::size_t columns_ = 0;  ///< number of columns along x
  std::vector<Wave> waves_;
  std::vector<std::array<float, kPoints * kPoints>> heights_;  ///< heights in each column, in cells
};

}  // namespace adamas::datasets
