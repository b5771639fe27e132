#pragma once

#include <cstddef>

#include "core/picture/colour.h"

namespace adamas::picture {

/// The number of different colours that `material_colour` gives before it starts again.
inline constexpr std::size_t kPaletteSize = 40;

/// The colour of material `index`: the first seven are those of Okabe and Ito (2008, "Color Universal
/// Design"), the others are chosen one by one to lie as far as possible from all before them, also as
/// colour-blind readers see them.
Colour material_colour(std::size_t index);

/// A colour for flat areas beneath lines: the material's colour, lightened.
Colour material_area_colour(std::size_t index);

/// The colour of a surface without materials: light, so that shading shows its form.
inline constexpr Colour kSurfaceColour{0.93, 0.85, 0.71};

}  // namespace adamas::picture
