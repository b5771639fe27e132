#pragma once

#include <cstddef>

#include "isosurface/contour/contour.h"

namespace adamas::isosurface {

/// The figures of a decimation.
struct Decimation {
  /// An estimate of the distance by which the surface has moved: the greatest root mean square distance of a
  /// collapsed point from the original planes, or of the points of a removed body from their centre.
  double error = 0;
  std::size_t bodies = 0;  ///< number of connected parts that were removed
};

/// Removes points from a contour until it has at most so many triangles, or none can be removed. Edges are
/// collapsed into one of their ends, those that change the surface least first, by the quadric error metric
/// (M. Garland, P. S. Heckbert, SIGGRAPH 1997) with planes weighted by area, up to a factor of 9/8 in the
/// squared error. Points that remain do not move.
///
/// No collapse changes the topology or turns a triangle by 60 degrees or more; once no other is left, by 90.
/// A connected part that has shrunk to twelve points, one of which cannot be removed, is removed as a whole
/// once errors elsewhere are greater than its size. Points of the border stay on it, and are removed only
/// where the border continues in a plane across an axis. The same contour gives the same result.
Decimation decimate_contour(Contour& contour, std::size_t triangles);

}  // namespace adamas::isosurface
