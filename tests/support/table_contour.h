#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "isosurface/contour/contour.h"
#include "isosurface/volume/z_order.h"
#include "tests/support/indexed_hierarchy.h"

namespace adamas::test {

using namespace isosurface;

/// A diamond of a hierarchy and its tetrahedra in the mesh.
struct PlacedDiamond {
  std::uint64_t place;  ///< in z-order
  std::uint8_t slots;   ///< as bits
};

/// The diamonds with tetrahedra in the mesh, in z-order, so that diamonds that are near in space are near in
/// memory.
class DiamondsInSpace {
 public:
  /// Lists the diamonds of the mesh, without those wholly beyond the last sample.
  DiamondsInSpace(const IndexedHierarchy& hierarchy, const std::optional<LatticePoint>& last_sample);

  /// Calls visit(diamond, slots).
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const PlacedDiamond& placed : diamonds_)
      visit(Diamond((1 << shift_) * ZOrder::deinterleave(placed.place)), unsigned{placed.slots});
  }

 private:
  int shift_;
  std::vector<PlacedDiamond> diamonds_;
};

/// Returns the contour of the piecewise linear function on a mesh that is kept as a table, with the given
/// values at its vertices. Tests compare the contours of stores with it. `values(p)` gives the value at the
/// lattice point p as a double; it is asked once for each vertex of a diamond, so several times for a vertex
/// of the mesh, and not for diamonds beyond the last sample. A value equal to the isovalue counts as above
/// it. Tetrahedra with a value that is not finite have no surface. The result depends on the mesh alone, not
/// on the order of the splits that led to it. Throws Error where the surface has more points than 32 bits can
/// number.
template <class Values>
Contour extract_contour(const IndexedHierarchy& hierarchy, const Values& values, double isovalue,
                        const ContourOptions& options = {}) {
  ContourBuilder builder(hierarchy.domain(), isovalue, options);
  DiamondContour contour(builder, isovalue, options.last_sample);
  DiamondsInSpace(hierarchy, options.last_sample).for_each([&](const Diamond& diamond, unsigned slots) {
    contour.add(diamond, slots, values);
  });
  return builder.finish();
}

}  // namespace adamas::test
