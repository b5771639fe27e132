#pragma once

#include <string>

#include "adamas/meshes.h"
#include "adamas/resample.h"
#include "cli/console.h"
#include "cli/figures.h"

namespace adamas::cli {

/// Throws Error, before the work, where --verify-by names a verifier whose program this build or installation
/// does not have.
void check_verifier(const std::string& name);

/// Measures the distance between the interfaces of the input and of the mesh by CGAL, prints it beside the
/// certified one, and adds it to the figures (`interface_error_by_cgal`). Notes a contradiction, which makes
/// the result incomplete.
void verify_interface_error(const AdaptiveMesh& mesh, const InterfaceTriangles& shown, Figures& figures,
                            Console& console);

}  // namespace adamas::cli
