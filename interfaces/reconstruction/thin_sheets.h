#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/sheet_fit.h"

namespace adamas {

class SiteValues;

/// A site in or beside a sheet of a material that is thinner than about a cell and a half.
struct SheetPlace {
  std::uint32_t site = 0;
  std::uint16_t material = 0;              ///< of the sheet: its number in the order of names
  std::array<std::uint16_t, 2> sides{};    ///< the same of what lies where the normal points, and behind
  std::array<std::uint32_t, 2> regions{};  ///< of the sides; ThinSheets::kNoRegion where these differ
  Slab slab;                               ///< round the site, in cells

  [[nodiscard]] bool has_twins() const { return sides[0] == sides[1]; }
};

/// Where thin sheets are. A material on both sides of a sheet is in two regions there, its twins, which are
/// the same wherever the same side of the same sheet is meant.
struct ThinSheets {
  static constexpr std::uint32_t kNoRegion = 0xffffffffu;

  std::vector<SheetPlace> places;               ///< in the order of sites
  std::vector<std::uint16_t> region_materials;  ///< by region
};

/// Finds sheets by fitting layers of even thickness to the fractions round mixed cells, and what they are
/// beside these. Sites where a sheet ends are in none.
ThinSheets find_thin_sheets(const MultiMaterialData& data, const SiteValues& values);

/// Joins the sides of places to regions and numbers these. Sides are joined along sheets and, where this
/// does not make both sides of a sheet one, through cells that hold one material alone.
void join_regions(const MultiMaterialData& data, const SiteValues& values, ThinSheets& sheets);

}  // namespace adamas
