#pragma once

#include "interfaces/reference_client/program_messages.h"

namespace adamas::interfaces::reference {

/// Meshes the complex by TetGen with the request's switches; the triangles' patches are its markers. Failures
/// that the library reports are in the reply; others end the process.
MesherReply run_tetgen(const MesherRequest& request);

/// Meshes the complex by CGAL's Mesh_3: the patches are surfaces of a polyhedral complex, whose borders are
/// protected.
MesherReply run_mesh3(const MesherRequest& request);

/// Meshes the image by CGAL's Mesh_3 as a labelled domain, in which nothing is protected.
MesherReply run_mesh3_labels(const MesherRequest& request);

/// Makes constrained Delaunay triangulations of planes by CGAL's Triangulation_2 with exact predicates. It
/// fails if segments cross or a point lies on one.
PlanarReply triangulate_planes(const PlanarRequest& request);

/// Finds bounds of the two-sided Hausdorff distance of triangles by CGAL's
/// bounded_error_Hausdorff_distance.
DistanceReply bracket_distance(const DistanceRequest& request);

}  // namespace adamas::interfaces::reference
