#pragma once

#include "interfaces/reference/mesher_messages.h"

namespace adamas::reference {

/// The complex with its triangles' patches as markers, by TetGen with the request's switches. Failures that
/// the library tells are the reply's; others end the process.
MesherReply run_tetgen(const MesherRequest& request);

/// The patches as surfaces of a polyhedral complex, their borders protected, by CGAL's Mesh_3.
MesherReply run_mesh3(const MesherRequest& request);

/// The image as CGAL's labelled domain, by Mesh_3. It protects nothing.
MesherReply run_mesh3_labels(const MesherRequest& request);

}  // namespace adamas::reference
