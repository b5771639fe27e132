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
  std::uint16_t material = 0;              ///< of the sheet: its number in the order of names
  std::array<std::uint16_t, 2> sides{};    ///< of what there is most of where the normal points, and behind
  std::array<std::uint32_t, 2> regions{};  ///< of the sides
  Slab slab;                               ///< round the site, in cells
  bool is_fitted = false;                  ///< to the fractions round the site itself

  /// Whether a cell, so many cells away from the site, has no part of the layer, if `fraction` is what it
  /// holds of the material: of a blurred layer by where the cell lies.
  [[nodiscard]] bool is_beside(const Vec3& away, float fraction) const {
    return slab.width > 0 ? std::abs(slab.height(away)) > 0.5 * (slab.thickness + 1) : fraction <= 0;
  }
};

/// Where thin sheets are. Their two sides are in different regions, which are the same wherever the same side
/// of the same sheet is meant.
struct ThinSheets {
  std::vector<SheetPlace> places;  ///< in the order of sites
  std::size_t regions = 0;
  double noise = 0;  ///< standard deviation of errors of fractions at blurred sheets, the mean over places
};

/// Finds sheets by fitting layers of even thickness to the fractions round mixed cells, and what they are
/// beside these. Sites where a sheet ends are in none.
ThinSheets find_thin_sheets(const MultiMaterialData& data, const SiteValues& values);

/// Joins the sides of places to regions and numbers these. Sides are joined along sheets and, where this
/// does not make both sides of a sheet one, through cells that hold nothing of the sheet.
void join_regions(const MultiMaterialData& data, const SiteValues& values, ThinSheets& sheets);

}  // namespace adamas::interfaces
