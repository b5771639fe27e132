#pragma once

#include <cstddef>

#include "isosurface/contour/contour.h"

namespace adamas::isosurface {

/// What decimation has done to a surface.
struct Decimation {
  /// Of a collapse the greatest root of the mean square distance from the planes that were there; of a body
  /// that was taken out the same of its points from their middle. An estimate of how far the surface has
  /// moved.
  double error = 0;
  std::size_t bodies = 0;  ///< parts that were taken out
};

/// Takes points out of a contour until it has at most so many triangles, or no more can be taken: edges are
/// collapsed into one of their ends, those first that change the surface least by the quadric error metric
/// (M. Garland, P. S. Heckbert, SIGGRAPH 1997), with planes weighted by area, up to a factor of 9/8 in
/// their squares. Points that stay are where they were.
///
/// No collapse changes the topology or turns a triangle by 60 degrees, or by 90 where there is no other any
/// more. A part of the surface that has shrunk to twelve points, one of which cannot be taken out, is taken
/// out as a whole once greater errors than its size are made elsewhere. Points of the border stay in it, and
/// are taken out only where it goes on in a plane across an axis. The same contour gives the same result.
Decimation decimate_contour(Contour& contour, std::size_t triangles);

}  // namespace adamas::isosurface
