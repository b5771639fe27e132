#pragma once

#include <cstdint>

#include "core/lattice/point_numbers.h"
#include "isosurface/contour/contour.h"

namespace adamas::isosurface {

/// Joins the points of edges: an edge has one number, whichever triangles name it.
class JoinedEdges {
 public:
  explicit JoinedEdges(Contour& contour) : contour_(contour) {}

  std::uint32_t number(const EdgePoint& point, const Vec3& position) {
    // No two edges of a mesh have the same middle.
    const LatticePoint way = point.second - point.first;
    const auto [number, is_new] =
        numbers_.insert(point.first + LatticePoint{way.i / 2, way.j / 2, way.k / 2});
    if (is_new) {
      *number = static_cast<std::uint32_t>(contour_.points.size());
      contour_.edge_points.push_back(point);
      contour_.points.push_back(position);
    }
    return *number;
  }

 private:
  Contour& contour_;
  PointNumbers numbers_;
};

}  // namespace adamas::isosurface
