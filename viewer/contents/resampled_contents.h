#pragma once

#include <memory>

#include "adamas/progress.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "viewer/contents/material_contents.h"

namespace adamas::viewer {

/// The contents of a resampled mesh.
std::unique_ptr<MaterialContents> make_resampled_contents(interfaces::ResampledMesh mesh, Progress& progress);

}  // namespace adamas::viewer
