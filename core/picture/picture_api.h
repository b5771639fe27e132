#pragma once

#include "adamas/picture.h"
#include "core/picture/interface_picture.h"

namespace adamas::picture {

/// The picture of the interfaces that options select, with a legend unless there are very many materials.
/// Throws Error as write_picture does for what cannot be drawn.
InterfacePicture interface_picture(const InterfaceTriangles& interfaces, const DrawingOptions& options);

/// The size of a picture of surfaces, and how its triangles are drawn.
InterfacePictureOptions surface_drawing(const DrawingOptions& options);

}  // namespace adamas::picture
