#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// The agreement of the volumes of materials in the cells of sites with the fractions there.
struct VolumeAgreement {
  std::size_t mixed_cells = 0;
  /// The number of mixed cells where a material's volume or, for a blurred one, the predicted fraction
  /// differs from its fraction by more than the tolerance.
  std::size_t cells_off = 0;
  /// A thousandth of the cell, or three standard deviations of the fractions' errors if these are more.
  double tolerance = 0;
  double greatest = 0, mean = 0;  ///< differences in a mixed cell, relative to the cell's volume
  /// The number of cells that one material fills and of which others get more than a thousandth.
  std::size_t full_cells_off = 0;
  double greatest_in_full_cell = 0;  ///< difference, relative to the cell's volume
};

/// A part of a site's cell that goes from one material to another.
struct VolumeMove {
  std::uint32_t site;
  MaterialId from, to;
  double volume;  ///< relative to the cell's volume
};

/// Compares volumes with fractions, after the volumes `moves` are moved between materials. The result is
/// empty if no cell is mixed.
VolumeAgreement volume_agreement(const MultiMaterialData& data, const SiteValues& values,
                                 const SiteCells& cells, std::vector<VolumeMove> moves);

}  // namespace adamas::interfaces
