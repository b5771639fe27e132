#pragma once

#include <span>

#include "adamas/error_target.h"
#include "adamas/volume.h"

namespace adamas::timevarying {

// Each function throws Error (kUsage), which names the option as on the command line, for a value that is not
// allowed.

/// Checks that an isovalue is finite.
void check_isovalue(double isovalue);
/// Checks that the isovalues of one surface are finite and differ from each other.
void check_isovalues(std::span<const double> isovalues);
/// Checks that an isosurface error is finite and at least 0.
void check_surface_error(const ErrorTarget& error);
/// Checks an isosurface error and returns it in units of length.
double surface_error(const ErrorTarget& error, const VolumeGrid& grid);

}  // namespace adamas::timevarying
