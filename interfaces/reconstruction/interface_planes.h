#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "adamas/geometry.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/numbered_entries.h"

namespace adamas::interfaces {

class SiteValues;

/// The plane that cuts a material's fraction off a mixed cell.
struct InterfacePlane {
  Vec3 towards;         ///< unit normal into the material; zero if no plane is known
  double distance = 0;  ///< the distance of the cell's centre, positive in the material

  [[nodiscard]] bool known() const { return squared_norm(towards) > 0; }
};

/// Returns the lengths of a cell's sides along a normal, ascending.
std::array<double, 3> plane_sides(const Vec3& towards, const Vec3& size);
/// Returns the signed distance of a cell's centre from the plane that cuts off the part f of the cell on the
/// side to which the unit vector `towards` points. `size`: the size of the cell.
double plane_distance(const Vec3& towards, const Vec3& size, double f);
/// Returns the part of the cell for a distance: the inverse of plane_distance().
double part_behind_plane(const Vec3& towards, const Vec3& size, double distance);

/// Returns the gradient of a material's fractions at a site, by least squares with Youngs' weights; one-sided
/// at the grid's border.
Vec3 fraction_gradient(const GridSites& sites, std::size_t site, std::span<const float> fractions);

/// The planes of the entries that have one.
class InterfacePlanes {
 public:
  InterfacePlanes(NumberedEntries numbers, std::vector<InterfacePlane> planes)
      : numbers_(std::move(numbers)), planes_(std::move(planes)) {}

  /// Returns the plane of an entry, which is not known for most blurred entries.
  [[nodiscard]] const InterfacePlane& of(std::size_t entry) const { return planes_[numbers_.number(entry)]; }

 private:
  NumberedEntries numbers_;
  std::vector<InterfacePlane> planes_;  // by number; that of 0 is not known
};

/// Returns the planes of all entries of mixed sites that are not blurred. Normals start as gradients of the
/// fractions (Youngs); then each is repeatedly replaced by the normal of the plane through the centroids of
/// the pieces in the cells round it (Swartz; Mosso and Clancy, 1994). Planes are reproduced exactly.
InterfacePlanes interface_planes(const MultiMaterialData& data, const SiteValues& values);

}  // namespace adamas::interfaces
