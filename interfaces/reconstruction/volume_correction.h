#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// How well the volumes of materials in the cells of sites agree with the fractions there.
struct VolumeAgreement {
  std::size_t mixed_cells = 0;
  /// Mixed cells where a material's volume, or, of a blurred one, the fraction that it should have, differs
  /// by more than the tolerance.
  std::size_t cells_off = 0;
  double tolerance = 0;  ///< a thousandth of the cell, or three standard deviations of errors of fractions
  double greatest = 0, mean = 0;  ///< difference in a mixed cell, as a part of the cell's volume
  /// Cells that one material fills, of which others get more than a thousandth.
  std::size_t full_cells_off = 0;
  double greatest_in_full_cell = 0;  ///< difference, as above
};

/// Changes values until the volume of each material in each mixed cell, and in those beside them that others
/// would get into, is that of its fraction, as far as that can be had (see VolumeAgreement), and then closes
/// the totals. `cells`: of the data's grid, here and below.
void correct_volumes(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells,
                     Progress& progress);

/// A part of a site's cell that goes from one material to another.
struct VolumeMove {
  std::uint32_t site;
  MaterialId from, to;
  double volume;  ///< in cells
};

/// How well volumes agree, with some moved; nothing to tell where no cell is mixed.
VolumeAgreement volume_agreement(const MultiMaterialData& data, const SiteValues& values,
                                 const SiteCells& cells, std::vector<VolumeMove> moves);

/// Adds an offset to the values of each body, a connected part of what a material owns, so that it has the
/// volume of the fractions in and about it. For blurred fractions, whose cells say less than their sum.
void close_bodies(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells,
                  Progress& progress);

/// Adds an offset to the values of each material, so that the materials have the volumes `wanted` in the
/// whole domain. Of offsets that would spoil cells a site's share is the greater, the more of the mixed cells
/// round it are off anyway. Newton's method, for the volumes are the gradient of a convex function of the
/// offsets.
void close_totals(const MultiMaterialData& data, const IdVector<MaterialId, double>& wanted,
                  SiteValues& values, const SiteCells& cells, Progress& progress);

}  // namespace adamas::interfaces
