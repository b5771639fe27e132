#pragma once

#include <vector>

#include "adamas/reconstruct.h"
#include "core/data/interface_mesh.h"
#include "interfaces/input/resampling_source.h"

namespace adamas::interfaces {

/// The triangles and areas of the interfaces of a mesh, in the order of their materials.
std::vector<InterfaceArea> interface_areas(const InterfaceMesh& mesh);
/// The same of the interfaces of a source, with their areas in the domain.
std::vector<InterfaceArea> interface_areas(const ResamplingSource& source);

}  // namespace adamas::interfaces
