#pragma once

#include "adamas/geometry.h"
#include "isosurface/view/viewpoint.h"
#include "viewer/contents/drawn_mesh.h"

namespace adamas::viewer {

/// The edges of a box.
SharedMesh lines_of_box(const Box3& box);

/// The edges of the space that a viewpoint shows, from near the eye to its target: a pyramid, or a prism in
/// parallel projection.
SharedMesh lines_of_view(const isosurface::Viewpoint& viewpoint);

}  // namespace adamas::viewer
