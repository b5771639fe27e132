#pragma once

#include <string>

#include "adamas/meshes.h"
#include "adamas/resample.h"
#include "cli/console.h"
#include "cli/figures.h"

namespace adamas::cli {

/// Throws Error, before the work, where --verify-by names a verifier and this build or installation is
/// without the program that it takes.
void check_verifier(const std::string& name);

/// Measures the distance between the input's interfaces and those that the mesh shows by CGAL, prints it
/// beside the certified one, and adds it to the figures (`interface_error_by_cgal`). Notes a contradiction,
/// which makes the result incomplete.
void verify_interface_error(const AdaptiveMesh& mesh, const InterfaceTriangles& shown, Figures& figures,
                            Console& console);

}  // namespace adamas::cli
