#pragma once

#include <string>

#include "core/picture/interface_picture.h"

namespace adamas::picture {

/// A picture of surfaces as a page of HTML that turns in a browser: materials go on and off, a plane cuts,
/// and shows what the picture's block has there.
/// One file that needs nothing else and no network; it draws by WebGL, with three.js. Each side of a triangle
/// belongs to the entry of the legend that has its colour. Throws Error for points that are not finite, and
/// where this build has no three.js.
std::string turning_page(const InterfacePicture& picture);

}  // namespace adamas::picture
