#pragma once

#include <cstddef>

#include "core/picture/colour.h"

namespace adamas::picture {

/// The number of different colours of `material_colour` before they repeat.
inline constexpr std::size_t kPaletteSize = 40;

/// The colour of material `index`: the first seven are those of Okabe and Ito (2008, "Color Universal
/// Design"); each of the others is as far as possible from all before it, also as colour-blind readers see
/// them.
Colour material_colour(std::size_t index);

/// A colour for flat areas under lines: the material's colour, lightened.
Colour material_area_colour(std::size_t index);

/// The colour of a surface without materials: light, so that shading shows its form.
inline constexpr Colour kSurfaceColour{0.93, 0.85, 0.71};

}  // namespace adamas::picture
