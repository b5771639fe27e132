#pragma once

#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/data/interface_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

/// The leaves of a resampler that has refined, as a mesh on its own.
ResampledMesh resampled_mesh(const Resampler& resampler);

/// The interfaces that the leaves of a resampler show, between materials.
InterfaceMesh approximated_interfaces(const Resampler& resampler,
                                      Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
