#pragma once

#include <vector>

#include "adamas/reconstruct.h"
#include "core/data/interface_mesh.h"
#include "interfaces/input/resampling_source.h"

namespace adamas::interfaces {

/// Returns the triangles and areas of the interfaces of a mesh, in the order of their materials.
std::vector<InterfaceArea> interface_areas(const InterfaceMesh& mesh);
/// Returns the triangles of the interfaces of a source and their areas in the domain, in the order of their
/// materials.
std::vector<InterfaceArea> interface_areas(const ResamplingSource& source);

}  // namespace adamas::interfaces
