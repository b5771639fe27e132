#include "interfaces/reconstruction/label_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/distance/closest_point_tree.h"
#include "core/geometry/plane_sides.h"
#include "interfaces/reconstruction/label_lattice.h"
#include "interfaces/reconstruction/label_surfaces.h"
#include "interfaces/reconstruction/label_totals.h"

namespace adamas::interfaces {

namespace {

using Index = LabelLattice::Index;

/// Finds the cells of each row that a plane meets, and those before them along each axis, which have a say in
/// the last bits of their points.
class CellsAtPlane {
 public:
  CellsAtPlane(const LabelLattice& lattice, const PlaneSides& sides) : lattice_(lattice), sides_(sides) {
    for (std::uint32_t i = 0; i < lattice.points(0); ++i) x_.push_back(lattice.position({i, 0, 0}).x);
  }

  [[nodiscard]] CellsOfRow operator()(std::uint32_t j, std::uint32_t k) const {
    // The plane meets a cell or those behind it if it meets the box of all these.
    const Vec3 low = lattice_.position({0, j, k});
    const Vec3 high = lattice_.position(
        {0, std::min(j + 2, lattice_.points(1) - 1), std::min(k + 2, lattice_.points(2) - 1)});
    const auto [from, to] = sides_.bounds_along(0, {low, high});
    const auto first = std::ranges::lower_bound(x_, from) - x_.begin(),
               last = std::ranges::upper_bound(x_, to) - x_.begin();
    return {static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(first - 2, 0)),
            static_cast<std::uint32_t>(std::min<std::ptrdiff_t>(last, std::ssize(x_) - 1))};
  }

 private:
  const LabelLattice& lattice_;
  const PlaneSides& sides_;
  std::vector<double> x_;
};

/// The cells round the one of a point, and those before them along each axis, which have a say in the last
/// bits of their points.
struct CellsRound {
  /// `reach`: how many cells there are to either side, up to the border.
  CellsRound(const LabelLattice& lattice, const Vec3& p, std::uint32_t reach) {
    const Index cell = lattice.locate(p).cell;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const std::uint32_t end = lattice.points(axis) - 1;
      const std::uint32_t low = cell[a] - std::min(cell[a], reach), high = std::min(cell[a] + 1 + reach, end);
      Index at{};
      at[a] = low;
      if (low > 0) known = std::min(known, p[axis] - lattice.position(at)[axis]);
      at[a] = high;
      if (high < end) known = std::min(known, lattice.position(at)[axis] - p[axis]);
      first[a] = low - std::min(low, 1u);
      last[a] = high;
    }
  }

  Index first{}, last{};
  /// Interfaces in other cells are at least so far from the point.
  double known = std::numeric_limits<double>::infinity();
};

/// Returns whether a material may own a piece of a tetrahedron alone in a cell at the border. In others none
/// does where all are plain.
bool leaves_out_at_border(const LabelLattice& lattice) {
  const Index end{lattice.points(0) - 1, lattice.points(1) - 1, lattice.points(2) - 1};
  std::array<char, 6> found{};
  parallel_for(found.size(), 1, [&](std::size_t side) {
    Index first{}, last = end;
    const std::size_t axis = side / 2;
    if (side % 2 == 0) {
      last[axis] = 1;
    } else {
      first[axis] = end[axis] - 1;
    }
    found[side] = label_surfaces(lattice, first, last).left_out.empty() ? 0 : 1;
  });
  return std::ranges::count(found, 1) > 0;
}

}  // namespace

std::unique_ptr<LabelParts> LabelParts::make(const MultiMaterialData& data, Progress& progress) {
  const LoopProgress loops(progress);
  LabelLattice lattice(data);
  if (!lattice.has_equal_cells() || !lattice.has_even_spacing()) return nullptr;
  close_label_totals(data, data.volumes(), lattice, progress);
  if (!lattice.labels_stay() || !lattice.has_equal_cells()) return nullptr;
  const LoopProgress stage(progress, "reconstructing interfaces");
  if (leaves_out_at_border(lattice)) return nullptr;
  return std::unique_ptr<LabelParts>(
      new LabelParts(LabelInterfaces::without_triangles(data, std::move(lattice))));
}

InterfaceMesh LabelParts::near_plane(const MultiMaterialData& data, const Plane& plane) const {
  const LabelLattice& lattice = bodies_->lattice();
  const PlaneSides sides(plane, data.grid.domain(), data.source);
  LabelSurfaces surfaces = label_surfaces(lattice, CellsAtPlane(lattice, sides));
  InterfaceMesh mesh;
  mesh.source = data.source;
  mesh.materials = data.materials;
  mesh.points = std::move(surfaces.points);
  mesh.triangles = std::move(surfaces.triangles);
  const auto material = [&](MaterialId run) { return lattice.material(lattice.runs().number(run.value)); };
  for (InterfaceTriangle& t : mesh.triangles) t.front = material(t.front), t.back = material(t.back);
  return mesh;
}

std::optional<double> LabelParts::interface_distance(const Vec3& p) const {
  constexpr std::uint32_t kFarthest = 32;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!is_finite(p)) return kNone;
  for (std::uint32_t reach = 2; reach <= kFarthest; reach *= 2) {
    const CellsRound cells(bodies_->lattice(), p, reach);
    const LabelSurfaces surfaces = label_surfaces(bodies_->lattice(), cells.first, cells.last);
    std::vector<ClosestPointTree::Triangle> triangles;
    for (const InterfaceTriangle& t : surfaces.triangles) triangles.push_back(t.points);
    const auto nearest = ClosestPointTree(surfaces.points, triangles).closest(p);
    if (nearest && nearest->squared_distance <= cells.known * cells.known)
      return std::sqrt(nearest->squared_distance);
    if (std::isinf(cells.known)) return kNone;
  }
  return {};
}

}  // namespace adamas::interfaces
