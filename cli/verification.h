#pragma once

#include <string>

#include "cli/console.h"
#include "cli/figures.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::cli {

/// Throws Error, before the work, where --verify-by names a verifier and this build or installation is
/// without the program that it takes.
void check_verifier(const std::string& name);

/// Where --verify-by names a verifier, measures the distance between the input's interfaces and those of the
/// mesh by it, prints it beside the certified one, and adds it to the figures (`interface_error_by_cgal`).
/// Notes a contradiction, which makes the result incomplete.
void verify_interface_error(const std::string& name, const interfaces::Resampler& resampler, Figures& figures,
                            Console& console);

}  // namespace adamas::cli
