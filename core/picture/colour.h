#pragma once

#include <array>
#include <cstdint>

namespace adamas::picture {

/// A colour in sRGB, with components in 0..1 (gamma-encoded).
struct Colour {
  double r = 0, g = 0, b = 0;

  constexpr bool operator==(const Colour&) const = default;
};

/// A colour in CIE 1976 L*a*b* under the D65 white of sRGB; lightness in 0..100.
struct LabColour {
  double lightness = 0, a = 0, b = 0;
};

LabColour to_lab(const Colour& colour);
/// The nearest sRGB colour of the same lightness and hue: chroma is reduced until it can be shown.
Colour from_lab(const LabColour& lab);
/// A colour by lightness, chroma and hue angle in degrees.
Colour from_lch(double lightness, double chroma, double hue);

/// Colour vision: normal, without long-wave or without medium-wave cones (Machado, Oliveira and Fernandes
/// 2009, severity 1).
enum class Vision { kNormal, kProtanope, kDeuteranope };
Colour seen_by(Vision vision, const Colour& colour);

/// The colour (1 - t) a + t b, component by component.
constexpr Colour mix(const Colour& a, const Colour& b, double t) {
  return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
}

/// The three components rounded to 0..255.
std::array<std::uint8_t, 3> to_bytes(const Colour& colour);

}  // namespace adamas::picture
