#pragma once

#include <memory>

#include "adamas/progress.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "viewer/scene/material_scene.h"

namespace adamas::viewer {

/// The scene of a resampled mesh.
std::unique_ptr<MaterialScene> make_resampled_scene(interfaces::ResampledMesh mesh, Progress& progress);

}  // namespace adamas::viewer
