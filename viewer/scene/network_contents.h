#pragma once

#include <memory>

#include "adamas/progress.h"
#include "core/data/interface_mesh.h"
#include "viewer/scene/material_contents.h"

namespace adamas::viewer {

/// The contents of given interfaces, which are mended where they can be. Throws Error, naming their source,
/// for those that have no triangle between two materials and for numbers that make no mesh.
std::unique_ptr<MaterialContents> make_network_contents(InterfaceMesh mesh, Progress& progress);

}  // namespace adamas::viewer
