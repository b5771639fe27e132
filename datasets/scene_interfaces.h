#pragma once

#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/data/interface_mesh.h"
#include "datasets/scene.h"

namespace adamas::datasets {

/// The interfaces of a scene as a welded triangle network that ends on the box. It is exact, to round-off,
/// for planar scenes. Other scenes are extracted on a lattice of spacing at most `resolution`, six tetrahedra
/// to a cube, with functions interpolated linearly, with an error of about resolution^2 times the curvature;
/// if the interfaces are whole spheres the vertices are then moved onto them. Throws Error if the resolution
/// is not positive or gives more than 4096 cells along an axis.
InterfaceMesh scene_interfaces(const Scene& scene, double resolution,
                               Progress& progress = SilentProgress::instance());

}  // namespace adamas::datasets
