#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/sheet_fit.h"

namespace adamas::interfaces {

class SiteValues;

/// A site in or beside a sheet of a material that is thinner than about a cell and a half.
struct SheetPlace {
  std::uint32_t site = 0;
  std::uint16_t material = 0;  ///< the number of the sheet's material, in the order of names
  /// The numbers of the main materials on the side to which the normal points, and on the other side.
  std::array<std::uint16_t, 2> sides{};
  std::array<std::uint32_t, 2> regions{};  ///< the regions on these sides
  Slab slab;                               ///< the layer round the site; lengths are in cells
  bool is_fitted = false;                  ///< whether the layer was fitted to the fractions round this site

  /// Returns whether the cell at a distance of `away`, in cells, has no part of the layer, judged by its
  /// fraction of the material or, for a blurred layer, by its position.
  [[nodiscard]] bool is_beside(const Vec3& away, float fraction) const {
    return slab.width > 0 ? std::abs(slab.height(away)) > 0.5 * (slab.thickness + 1) : fraction <= 0;
  }
};

/// The sites in and beside thin sheets. The two sides of a sheet are two different regions, which are the
/// same at all sites of the sheet.
struct ThinSheets {
  std::vector<SheetPlace> places;  ///< in the order of sites
  std::size_t regions = 0;
  /// The mean, over places of blurred sheets, of the standard deviation of the fractions' errors.
  double noise = 0;
};

/// Finds sheets by fitting layers of even thickness to the fractions round mixed cells, and continues them to
/// the sites beside these. Sites where a sheet ends belong to none.
ThinSheets find_thin_sheets(const MultiMaterialData& data, const SiteValues& values);

}  // namespace adamas::interfaces
