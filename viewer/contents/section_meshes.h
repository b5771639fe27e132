#pragma once

#include <cstddef>

#include "core/geometry/plane.h"
#include "interfaces/cross_section/cross_section.h"
#include "viewer/contents/material_contents.h"

namespace adamas::viewer {

/// Whether cross_section accepts the plane, which must have a normal and cut the box.
bool cuts(const Plane& plane, const Box3& box);

/// The meshes of a cross section by such a plane, with places relative to `origin`.
MaterialContents::Section section_meshes(const interfaces::CrossSection& section, const Plane& plane,
                                         const Vec3& origin);

}  // namespace adamas::viewer
