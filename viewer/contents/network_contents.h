#pragma once

#include <memory>

#include "adamas/progress.h"
#include "core/data/interface_mesh.h"
#include "viewer/contents/material_contents.h"

namespace adamas::viewer {

/// The contents of given interfaces, which are repaired if possible. Throws Error, naming their source, if
/// they have no triangle between two materials, and for numbers that make no mesh.
std::unique_ptr<MaterialContents> make_network_contents(InterfaceMesh mesh, Progress& progress);

}  // namespace adamas::viewer
