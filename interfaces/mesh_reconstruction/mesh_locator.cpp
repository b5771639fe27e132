#include "interfaces/mesh_reconstruction/mesh_locator.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace adamas::interfaces {

MeshLocator::MeshLocator(const MeshSubdivision& subdivision) : subdivision_(subdivision) {
  const PolyhedralMesh& mesh = subdivision.mesh();
  std::vector<Box3> boxes(mesh.cell_count());
  for (std::size_t c = 0; c < boxes.size(); ++c) {
    for (const Index p : mesh.points_of_cell(c)) boxes[c].extend(mesh.points()[p]);
  }
  boxes_ = BoxTree(boxes);
}

MeshLocator::Location MeshLocator::locate(const Vec3& p) const {
  std::vector<std::uint32_t> cells;
  double radius = 0;
  const double diagonal = subdivision_.mesh().box().diagonal();
  for (double next = 1e-9 * diagonal; cells.empty(); radius = next, next *= 4) boxes_.near(p, radius, cells);
  Location best{{}, {}, 0};
  double most = -std::numeric_limits<double>::infinity();
  for (const Index cell : cells) {
    subdivision_.for_each_tetrahedron(cell, [&](const std::array<Index, 4>& corners) {
      std::array<Vec3, 4> x;
      for (std::size_t i = 0; i < 4; ++i) x[i] = subdivision_.position(corners[i]);
      const double volume = signed_volume(x[0], x[1], x[2], x[3]);
      if (volume == 0) return;
      const std::array<double, 4> w{
          signed_volume(p, x[1], x[2], x[3]) / volume, signed_volume(x[0], p, x[2], x[3]) / volume,
          signed_volume(x[0], x[1], p, x[3]) / volume, signed_volume(x[0], x[1], x[2], p) / volume};
      const double least = *std::ranges::min_element(w);
      if (least > most) best = {corners, w, cell}, most = least;
    });
  }
  return best;
}

}  // namespace adamas::interfaces
