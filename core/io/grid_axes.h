#pragma once

#include <array>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "core/io/grid_file.h"

namespace adamas::io {

/// The greatest deviation of a direction that counts as parallel, relative to its length: headers state
/// rotations in single precision.
inline constexpr double kParallelAxes = 1e-4;

/// Lays a grid out along x, y and z. Before, its nodes are positions along the array's axes; axes are
/// permuted and reversed together with the arrays, so that positions are right and nodes ascend. If the axes
/// are not parallel to x, y and z, one to each, they become `file.aslant`, and the grid stays as it is.
void lay_out(const GridAxes& axes, GridFile& file);

/// Whether axes are parallel to x, y and z, one to each, so that a grid can be laid out along these.
bool are_parallel(const GridAxes& axes);

/// The step between nodes along an axis (0 to 2), 1 if there is one node. Throws Error with `name` if there
/// is none, or if steps differ.
double even_step(const std::string& name, int axis, const std::vector<double>& nodes);

/// Requires a grid that could be laid out: throws Error with `name` where it could not.
void require_laid_out(const std::string& name, const GridFile& file);

}  // namespace adamas::io
