#pragma once

#include <cstdint>
#include <vector>

#include "core/data/interface_mesh.h"

namespace adamas::viewer {

/// The surface between two materials of an interface mesh, with vertices that have one normal each.
struct PairSurface {
  struct Vertex {
    std::uint32_t point;     ///< its number in the interface mesh
    std::uint32_t triangle;  ///< a triangle of the interface mesh that has the vertex
    Vec3 normal;             ///< unit normal towards the front; zero if triangles have no area
  };
  MaterialId front, back;  ///< front < back
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three for each triangle, counterclockwise as seen from the front
  double area = 0;
};

/// The surfaces between any two materials that touch, in the order of their numbers; triangles between bodies
/// of one material are left out. A vertex is a point and those triangles of the pair round it that follow
/// each other without a crease; its normal is their average by the angles at the point.
std::vector<PairSurface> pair_surfaces(const InterfaceMesh& mesh);

}  // namespace adamas::viewer
