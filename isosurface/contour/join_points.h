#pragma once

#include "isosurface/contour/contour.h"

namespace adamas::isosurface {

/// Regularised marching tetrahedra (G. M. Treece, R. W. Prager, A. H. Gee, Computers & Graphics 23, 1999):
/// the points of a contour that lie on edges of one vertex of the mesh, in the half next to it, become their
/// mean. That leaves about a third of the triangles, without the narrow ones.
///
/// Points are joined where the edges and triangles among them form a disc, so that the surface keeps its
/// topology; and where that would lay two edges between the same points, or two triangles on each other,
/// they are not. Points at the border of the contour stay as they are. The contour is not to be clipped yet:
/// all its points are on edges; joined ones are then vertex points.
void join_points(Contour& contour);

}  // namespace adamas::isosurface
