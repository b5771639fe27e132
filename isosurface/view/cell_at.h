#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "core/geometry/vec3.h"
#include "core/lattice/diamond.h"
#include "core/lattice/domain.h"

namespace adamas {

/// A tetrahedron, and where a place lies in it: the weights of its vertices, which add up to 1.
struct WeightedCell {
  std::array<LatticePoint, 4> vertices;
  std::array<double, 4> weights;
};

/// The tetrahedron of a diamond that holds a place, or is nearest to holding it.
inline WeightedCell weighted_cell(const Diamond& diamond, const Domain& domain, const Vec3& place) {
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

/// The point of the diamond to which the cell belongs that holds a place in the mesh that comes from a root
/// diamond by splitting all diamonds for which is_split(point). No diamond between samples may be split.
template <class IsSplit>
LatticePoint diamond_at(const Diamond& root, const Domain& domain, const Vec3& place, IsSplit&& is_split) {
  WeightedCell cell = weighted_cell(root, domain, place);
  while (true) {
    // The split edge is the longest one in the lattice.
    std::array<std::size_t, 2> edge{0, 1};
    double longest = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) {
        const LatticePoint way = cell.vertices[b] - cell.vertices[a];
        const double length = double(way.i) * way.i + double(way.j) * way.j + double(way.k) * way.k;
        if (length <= longest) continue;
        longest = length;
        edge = {a, b};
      }
    }
    const auto [a, b] = edge;
    const LatticePoint p = cell.vertices[a], q = cell.vertices[b];
    const LatticePoint middle{p.i + (q.i - p.i) / 2, p.j + (q.j - p.j) / 2, p.k + (q.k - p.k) / 2};
    if (!is_split(middle)) return middle;
    // The half of the end that weighs more; the middle takes as much from both ends.
    const std::size_t kept = cell.weights[a] >= cell.weights[b] ? a : b, gone = kept == a ? b : a;
    cell.weights[kept] -= cell.weights[gone];
    cell.weights[gone] *= 2;
    cell.vertices[gone] = middle;
  }
}

}  // namespace adamas
