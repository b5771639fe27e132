#pragma once

#include <string>

#include "core/picture/interface_picture.h"

namespace adamas::picture {

/// A picture of surfaces as a page of HTML that can be turned in a browser: materials can be hidden, and a
/// plane cuts the surfaces and shows the contents of the picture's block there. The page is one
/// self-contained file and needs no network; it draws by WebGL, with three.js. Each side of a triangle
/// belongs to the entry of the legend that has its colour. Throws Error for points that are not finite, and
/// if this build has no three.js.
std::string turning_page(const InterfacePicture& picture);

}  // namespace adamas::picture
