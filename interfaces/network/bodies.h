#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/typed_id.h"
#include "core/data/interface_mesh.h"
#include "core/distance/closest_point_tree.h"
#include "interfaces/network/edge_fans.h"

namespace adamas::interfaces {

/// The connected parts of the materials' regions (docs/method.md, Who owns a point of a cell).
struct Bodies {
  /// The bodies in front of each triangle of the mesh and behind it; invalid if two of its points coincide.
  std::vector<std::array<BodyId, 2>> sides;
  /// The bodies are in the order of their materials, and within one material in the order of their first
  /// triangles.
  IdVector<BodyId, MaterialId> materials;
  /// The number of edges round which the materials do not match: a sign of badly oriented triangles.
  std::size_t inconsistent_edges = 0;
  /// The number of rays that started in one material and arrived at a side of another: a sign of badly
  /// oriented triangles or of gaps.
  std::size_t inconsistent_rays = 0;
};

/// Finds the bodies that the triangles of a mesh bound. Sides of triangles that face the same wedge round an
/// edge belong together. Parts of the boundary of one region that no triangles connect (the inside and the
/// outside of a shell, two planes that end at the domain) are joined by rays from the extreme points of each
/// part and in random directions, which are the same in every run. Rays that leave the domain continue along
/// its faces to the greatest corner. If `domain` is null, the regions of one material that reach infinity are
/// one body. Points must be finite and indices within range.
Bodies find_bodies(const InterfaceMesh& mesh, const Box3* domain);
/// The same with the mesh's fans of triangles in that domain.
Bodies find_bodies(const InterfaceMesh& mesh, const EdgeFans& fans, const Box3* domain);

}  // namespace adamas::interfaces
