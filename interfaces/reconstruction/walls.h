#pragma once

#include <cstddef>
#include <vector>

#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

class GridSites;

/// A wall is a material whose step is sharp where others before it are blurred, such as a solid in a diffuse
/// gas. Fractions of the others then count relative to what the wall leaves of a cell, and their interfaces
/// continue into it; the wall's own interface is that of its planes (docs/blurred_fractions.md, Sharp walls).

/// Finds the entries of walls: a material is a wall round a blurred cell if nearly all its steps there are
/// sharp and two other materials have blurred ones. Entries are marked at cells that the wall cuts and beside
/// those that it fills, but not at sites of thin sheets. `is_blurred` is indexed by site.
void find_walls(const RectilinearGrid& grid, const ThinSheets& sheets, const std::vector<char>& is_blurred,
                SiteValues& values);

/// Returns whether a site has an entry of a wall.
bool has_wall(const SiteValues& values, std::size_t site);

/// Return the part of a cell that its walls leave, above 0, and a fraction relative to that part, below 1.
double part_before_walls(const SiteValues& values, std::size_t site);
double fraction_before_walls(const SiteValues& values, std::size_t site, float fraction);

/// Convert between distances from walls' planes and values of walls. A wall's value owns the same volume
/// beside the greatest of the other materials at a site: the greatest other value plus twice the distance.
/// Before the conversion to values, the others' values are continued into walls linearly.
void set_values_at_walls(const RectilinearGrid& grid, SiteValues& values);
void set_distances_at_walls(SiteValues& values);

}  // namespace adamas::interfaces
