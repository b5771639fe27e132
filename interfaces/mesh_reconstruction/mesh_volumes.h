#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "interfaces/mesh_reconstruction/mesh_values.h"

namespace adamas::interfaces {

/// The volumes that materials own in active cells, as parts of the cells.
class MeshVolumes {
 public:
  using Index = MeshSubdivision::Index;
  explicit MeshVolumes(const MeshValues& values);

  /// Measures with the values as they are; values.interpolate() has been called since they changed. With
  /// `growth`, also what pairs of materials exchange.
  void measure(bool growth);
  /// The part of a cell that each of its entries owns; that of the n-th active cell.
  [[nodiscard]] std::span<const double> parts(std::size_t n) const {
    return std::span(parts_).subspan(first_[n], first_[n + 1] - first_[n]);
  }
  /// The derivative of each part with respect to its material's offset.
  [[nodiscard]] std::span<const double> growths(std::size_t n) const {
    return std::span(growths_).subspan(first_[n], first_[n + 1] - first_[n]);
  }
  /// The derivatives of the volume that the first material gets from the second one with respect to the
  /// differences of their values at points of the subdivision, and their sum.
  struct Exchange {
    std::uint16_t first, second;
    double growth;
    std::vector<std::pair<Index, double>> of_points;
  };
  /// The exchanges of an active cell.
  [[nodiscard]] const std::vector<Exchange>& exchanges(std::size_t n) const { return exchanges_[n]; }

 private:
  void measure_cell(std::size_t n, bool growth);

  const MeshValues& values_;
  std::vector<std::size_t> first_;
  std::vector<double> parts_, growths_;
  std::vector<std::vector<Exchange>> exchanges_;
};

}  // namespace adamas::interfaces
