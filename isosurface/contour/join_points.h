#pragma once

#include "isosurface/contour/contour.h"

namespace adamas::isosurface {

/// Joins points of a contour by regularised marching tetrahedra (G. M. Treece, R. W. Prager, A. H. Gee,
/// Computers & Graphics 23, 1999): the points on edges of one vertex of the mesh, in the half next to it,
/// become one point, their mean. This leaves about a third of the triangles, without the narrow ones.
///
/// Points are joined only if the edges and triangles between them form a disc, so that the surface keeps its
/// topology, and not if two edges between the same points or two coinciding triangles would result. Points at
/// the border of the contour stay as they are. The contour must not have been clipped: all its points lie on
/// edges. Joined points become vertex points.
void join_points(Contour& contour);

}  // namespace adamas::isosurface
