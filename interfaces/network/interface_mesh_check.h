#pragma once

#include <cstddef>

#include "adamas/geometry.h"
#include "core/base/error.h"
#include "core/data/interface_mesh.h"

namespace adamas::interfaces {

/// The counts of elements and tolerable faults of an interface mesh.
struct InterfaceMeshReport {
  std::size_t points = 0;     ///< distinct points that triangles use
  std::size_t triangles = 0;  ///< triangles with an area
  std::size_t degenerate_triangles = 0;
  std::size_t junction_edges = 0;  ///< edges with more than two triangles
  std::size_t domain_edges = 0;    ///< edges with one triangle, in a face of the domain
  /// Other edges with one triangle; points beyond them may get a wrong material.
  std::size_t open_border_edges = 0;
  std::size_t flipped_edges = 0;  ///< edges round which materials do not match; 0 unless this is allowed
  std::size_t intersections = 0;  ///< pairs of intersecting triangles without a common point; 0 unless this
                                  ///< is allowed
};

struct InterfaceCheckOptions {
  bool allow_flipped_edges = false;
  bool allow_intersections = false;
};

/// A fault that the options can allow.
class TolerableFault : public Error {
 public:
  using Error::Error;
};

/// Throws Error that names the mesh and the first of these faults: no triangles, points that are not finite,
/// indices and materials out of range, the same material on both sides of a triangle.
void check_interface_arrays(const InterfaceMesh& mesh);

/// Throws Error that names the mesh and the first fault: those of check_interface_arrays(), no triangle with
/// an area, edges round which the materials do not match (triangles turned the wrong way, or missing),
/// triangles that intersect; the last two as TolerableFault. `domain` may be null.
InterfaceMeshReport check_interface_mesh(const InterfaceMesh& mesh, const Box3* domain,
                                         const InterfaceCheckOptions& options = {});

}  // namespace adamas::interfaces
