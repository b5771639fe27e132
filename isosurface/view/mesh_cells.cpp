#include "isosurface/view/mesh_cells.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/geometry/box_clip.h"

namespace adamas::isosurface {

namespace {

/// The vertices of a tetrahedron at the ends of its split edge, the longest one in the lattice; and its
/// middle.
struct SplitEdge {
  std::size_t first = 0, second = 1;
  LatticePoint middle;
};

SplitEdge split_edge(const std::array<LatticePoint, 4>& vertices) {
  SplitEdge edge;
  double longest = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) {
      const LatticePoint way = vertices[b] - vertices[a];
      const double length = double(way.i) * way.i + double(way.j) * way.j + double(way.k) * way.k;
      if (length <= longest) continue;
      longest = length;
      edge = {a, b, vertices[a] + LatticePoint{way.i / 2, way.j / 2, way.k / 2}};
    }
  }
  return edge;
}

/// A tetrahedron and the weights of its vertices for a place, which add up to 1.
struct WeightedCell {
  std::array<LatticePoint, 4> vertices;
  std::array<double, 4> weights;
};

/// Returns the tetrahedron of a diamond that contains a place, or is nearest to containing it.
WeightedCell weighted_cell(const Diamond& diamond, const Domain& domain, const Vec3& place) {
  WeightedCell best{};
  double best_weight = -std::numeric_limits<double>::infinity();
  for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
    WeightedCell cell{diamond.tetrahedron(slot), {}};
    std::array<Vec3, 4> to;
    for (std::size_t n = 0; n < 4; ++n) to[n] = domain.position(cell.vertices[n]) - place;
    const auto volume = [&](std::size_t a, std::size_t b, std::size_t c) {
      return dot(to[a], cross(to[b], to[c]));
    };
    cell.weights = {volume(1, 3, 2), volume(0, 2, 3), volume(0, 3, 1), volume(0, 1, 2)};
    const double sum = cell.weights[0] + cell.weights[1] + cell.weights[2] + cell.weights[3];
    for (double& weight : cell.weights) weight /= sum;
    const double least = std::ranges::min(cell.weights);
    if (least > best_weight) {
      best = cell;
      best_weight = least;
    }
  }
  return best;
}

/// Returns the corners of a tetrahedron's section in a plane that cuts it, in order round it.
std::vector<Vec3> section_of_cell(const std::array<Vec3, 4>& corners, const Plane& plane) {
  std::array<double, 4> height{};
  std::vector<std::size_t> above, below;
  for (std::size_t n = 0; n < 4; ++n) {
    height[n] = dot(plane.normal, corners[n] - plane.origin);
    (height[n] >= 0 ? above : below).push_back(n);
  }
  std::vector<Vec3> polygon;
  const auto add = [&](std::size_t a, std::size_t b) {
    polygon.push_back(corners[a] + (height[a] / (height[a] - height[b])) * (corners[b] - corners[a]));
  };
  for (std::size_t n = 0; n < above.size(); ++n) {
    // With two corners on either side, the second ones come in the reverse order.
    for (std::size_t m = 0; m < below.size(); ++m) add(above[n], below[n == 0 ? m : below.size() - 1 - m]);
  }
  return polygon;
}

/// Calls visit(corners) for the cells that a plane cuts, in a fixed order; points in the plane count as lying
/// above it.
template <class Visit>
void for_each_cell_across(const Diamond& root, const Domain& domain, const Plane& plane,
                          const IsSplit& is_split, Visit&& visit) {
  std::vector<std::array<LatticePoint, 4>> cells;
  for (int slot = root.tetrahedron_count(); slot-- > 0;) cells.push_back(root.tetrahedron(slot));
  while (!cells.empty()) {
    const std::array<LatticePoint, 4> cell = cells.back();
    cells.pop_back();
    std::array<Vec3, 4> corners;
    std::size_t above = 0;
    for (std::size_t n = 0; n < 4; ++n) {
      corners[n] = domain.position(cell[n]);
      above += dot(plane.normal, corners[n] - plane.origin) >= 0 ? 1 : 0;
    }
    if (above == 0 || above == 4) continue;
    const auto [a, b, middle] = split_edge(cell);
    if (!is_split(middle)) {
      visit(corners);
      continue;
    }
    for (const std::size_t gone : {b, a}) {
      cells.push_back(cell);
      cells.back()[gone] = middle;
    }
  }
}

}  // namespace

LatticePoint diamond_at(const Diamond& root, const Domain& domain, const Vec3& place,
                        const IsSplit& is_split) {
  WeightedCell cell = weighted_cell(root, domain, place);
  while (true) {
    const auto [a, b, middle] = split_edge(cell.vertices);
    if (!is_split(middle)) return middle;
    // The half of the end with the greater weight is kept; the middle takes as much from both ends.
    const std::size_t kept = cell.weights[a] >= cell.weights[b] ? a : b, gone = kept == a ? b : a;
    cell.weights[kept] -= cell.weights[gone];
    cell.weights[gone] *= 2;
    cell.vertices[gone] = middle;
  }
}

std::vector<std::vector<Vec3>> cells_in(const Diamond& root, const Domain& domain, const Plane& plane,
                                        const Box3& box, const IsSplit& is_split) {
  std::vector<std::vector<Vec3>> polygons;
  std::vector<Vec3> scratch;
  for_each_cell_across(root, domain, plane, is_split, [&](const std::array<Vec3, 4>& corners) {
    std::vector<Vec3> polygon = section_of_cell(corners, plane);
    clip_to_box(polygon, box, scratch);
    if (polygon.size() > 2) polygons.push_back(std::move(polygon));
  });
  return polygons;
}

}  // namespace adamas::isosurface
