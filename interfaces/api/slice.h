#pragma once

#include <string>
#include <vector>

#include "adamas/meshes.h"
#include "interfaces/cross_section/cross_section.h"

namespace adamas::interfaces {

/// Returns a section as one piece of arrays; it has no name of a field.
Slice to_slice(CrossSection section, const Plane& plane, const std::vector<std::string>& materials);

}  // namespace adamas::interfaces
