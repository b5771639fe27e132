#pragma once

#include "adamas/fractions.h"
#include "adamas/progress.h"
#include "adamas/reconstruct.h"  // CellAgreement
#include "core/data/mesh_data.h"
#include "interfaces/mesh_reconstruction/mesh_values.h"

namespace adamas::interfaces {

/// What was found about the fractions of a mesh, and how well the values reproduce them.
struct MeshAgreement {
  FractionFindings findings;  ///< without the areas
  CellAgreement cells;
  std::vector<LostPlace> lost;  ///< groups of cells that hold a material of which nothing is shown there
  /// The volumes that the interfaces are to enclose: those of the input without dispersed parts.
  IdVector<MaterialId, double> volumes;
};

/// Takes dispersed fractions out, and sets values so that cells hold their fractions: distances from planes
/// that cut off the fractions of sharp materials, or those that a blurred step has, corrected in rounds by
/// the volumes in the cells; then closes the total of each material.
MeshAgreement correct_values(const MeshData& data, const FractionOptions& options, MeshValues& values,
                             Progress& progress);

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
  /// The derivative of the volume that the first material gets from the second one with respect to the
  /// difference of their offsets.
  struct Exchange {
    std::uint16_t first, second;
    double growth;
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
