#pragma once

#include <cstddef>

#include "core/geometry/plane.h"
#include "interfaces/cross_section/cross_section.h"
#include "viewer/document/material_contents.h"

namespace adamas::viewer {

/// Whether cross_section takes the plane: it has a normal and cuts the box.
bool cuts(const Plane& plane, const Box3& box);

/// A cross section by such a plane to be drawn, about `origin`.
MaterialContents::Section section_meshes(const interfaces::CrossSection& section, const Plane& plane,
                                         const Vec3& origin);

}  // namespace adamas::viewer
