#pragma once

#include <string_view>

#include "core/picture/raster.h"

namespace adamas::test {

using namespace picture;

/// Returns the pixels of a PNG file's bytes, decoded by Cairo. Throws Error for anything else.
Raster decode_png(std::string_view bytes);

}  // namespace adamas::test
