#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>

#include "adamas/picture.h"
#include "core/picture/interface_picture.h"
#include "core/picture/material_colours.h"

namespace adamas::picture {

/// The colour of a material: that under its name, or one by its number. `otherwise`: what gives that one.
Colour colour_of(const std::map<std::string, std::array<double, 3>>& colours, const std::string& name,
                 std::size_t number, Colour (*otherwise)(std::size_t) = material_colour);

/// The picture of the interfaces that options select, with a legend unless there are very many materials.
/// Throws Error as write_picture does for what cannot be drawn.
InterfacePicture interface_picture(const InterfaceTriangles& interfaces, const DrawingOptions& options);

/// The size of a picture of surfaces, and how its triangles are drawn.
InterfacePictureOptions surface_drawing(const DrawingOptions& options);

}  // namespace adamas::picture
