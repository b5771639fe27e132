#pragma once

#include <memory>

#include "adamas/progress.h"
#include "core/data/interface_mesh.h"
#include "viewer/scene/material_scene.h"

namespace adamas::viewer {

/// The scene of given interfaces, which are mended where they can be. Throws Error, naming their source, for
/// those that have no triangle between two materials and for numbers that make no mesh.
std::unique_ptr<MaterialScene> make_network_scene(InterfaceMesh mesh, Progress& progress);

}  // namespace adamas::viewer
