#pragma once

#include <cstddef>
#include <vector>

#include "core/data/multi_material_data.h"
#include "core/geometry/vec3.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// Cells that hold a material, by their fractions, of which their interfaces show nothing.
struct LostBody {
  MaterialId material;
  double volume = 0;  ///< as the fractions say
  std::size_t cells = 0;
  Vec3 place;           ///< the middle of that volume
  double fraction = 0;  ///< the greatest in one of the cells
};

/// Whether a fraction is no more than the least that its file can tell from nothing (FractionReport::step),
/// or what scaling its site to 1 has made of that.
bool is_one_step(double fraction, const FractionReport& report);

/// The connected groups of cells (by faces, edges and corners) with a fraction of a material above
/// kFractionTrace that together have more than a thousandth of a cell of it, and in which the material owns
/// nothing. In the order of their first cells. `values` must be of the same data.
std::vector<LostBody> find_lost_bodies(const MultiMaterialData& data, const SiteValues& values,
                                       const SiteCells& cells);

}  // namespace adamas::interfaces
