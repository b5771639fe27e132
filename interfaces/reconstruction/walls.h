#pragma once

#include <cstddef>
#include <vector>

#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

class GridSites;

/// A wall is a material whose step is sharp where others before it are blurred: a solid in a diffuse gas.
/// Fractions of the others then count as parts of what the wall leaves of a cell, and their interfaces run on
/// into it; the wall's own is that of its planes (docs/blurred_fractions.md, Sharp walls).

/// Marks the entries of walls, by `is_blurred` of sites: of materials whose steps are sharp nearly everywhere
/// round a blurred cell, where two others have blurred ones, at cells that they cut, or beside those that
/// they fill. No site of a thin sheet has any.
void find_walls(const RectilinearGrid& grid, const ThinSheets& sheets, const std::vector<char>& is_blurred,
                SiteValues& values);

/// Whether a site has an entry of a wall.
bool has_wall(const SiteValues& values, std::size_t site);

/// The part of a cell that its walls leave, above 0, and the part of that which a fraction is, below 1.
double part_before_walls(const SiteValues& values, std::size_t site);
double fraction_before_walls(const SiteValues& values, std::size_t site, float fraction);

/// Turns values of walls, which are distances from their planes, into those that own as much beside the
/// greatest of the others at a site: that and twice the distance. Before that the others' values are
/// continued into walls, linearly. And back: distances again.
void set_values_at_walls(const RectilinearGrid& grid, SiteValues& values);
void set_distances_at_walls(SiteValues& values);

}  // namespace adamas::interfaces
