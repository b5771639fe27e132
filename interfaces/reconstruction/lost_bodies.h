#pragma once

#include <cstddef>
#include <vector>

#include "adamas/geometry.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// Connected cells that hold a material by their fractions, though the interfaces show nothing of it there.
struct LostBody {
  MaterialId material;
  double volume = 0;  ///< by the fractions
  std::size_t cells = 0;
  Vec3 place;           ///< the centroid of that volume
  double fraction = 0;  ///< the greatest fraction in one of the cells
};

/// Returns whether a fraction is at most the least that its file can distinguish from 0
/// (FractionReport::step), before or after the site's sum is scaled to 1.
bool is_one_step(double fraction, const FractionReport& report);

/// Finds the connected groups of cells (by faces, edges and corners) with a fraction of a material above
/// kFractionTrace that together hold more than a thousandth of a cell of it and in which the material owns
/// nothing. The groups are in the order of their first cells. `values` must belong to `data`.
std::vector<LostBody> find_lost_bodies(const MultiMaterialData& data, const SiteValues& values,
                                       const SiteCells& cells);

}  // namespace adamas::interfaces
