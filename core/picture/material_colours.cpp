#include "core/picture/material_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace adamas::picture {
namespace {

constexpr std::array<Colour, 7> kFirstColours{{
    {0 / 255.0, 114 / 255.0, 178 / 255.0},    // blue
    {230 / 255.0, 159 / 255.0, 0 / 255.0},    // orange
    {0 / 255.0, 158 / 255.0, 115 / 255.0},    // bluish green
    {204 / 255.0, 121 / 255.0, 167 / 255.0},  // reddish purple
    {86 / 255.0, 180 / 255.0, 233 / 255.0},   // sky blue
    {213 / 255.0, 94 / 255.0, 0 / 255.0},     // vermillion
    {240 / 255.0, 228 / 255.0, 66 / 255.0},   // yellow
}};

// A colour as three kinds of colour vision see it.
using Seen = std::array<LabColour, 3>;

Seen seen_by_all(const Colour& colour) {
  return {to_lab(colour), to_lab(seen_by(Vision::kProtanope, colour)),
          to_lab(seen_by(Vision::kDeuteranope, colour))};
}

double least_difference(const Seen& p, const Seen& q) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < p.size(); ++k) {
    const double l = p[k].lightness - q[k].lightness, a = p[k].a - q[k].a, b = p[k].b - q[k].b;
    least = std::min(least, l * l + a * a + b * b);
  }
  return least;
}

std::vector<Colour> candidates() {
  std::vector<Colour> colours;
  for (const double lightness : {32.0, 44.0, 56.0, 68.0, 80.0}) {
    for (const double chroma : {25.0, 45.0, 65.0}) {
      for (int hue = 0; hue < 360; hue += 15) colours.push_back(from_lch(lightness, chroma, hue));
    }
  }
  return colours;
}

std::vector<Colour> make_palette() {
  std::vector<Colour> palette(kFirstColours.begin(), kFirstColours.end());
  const std::vector<Colour> pool = candidates();
  std::vector<Seen> seen;
  seen.reserve(pool.size());
  for (const Colour& colour : pool) seen.push_back(seen_by_all(colour));
  // White and black are reserved for the page and the lines.
  std::vector<Seen> taken{seen_by_all({1, 1, 1}), seen_by_all({0, 0, 0})};
  for (const Colour& colour : palette) taken.push_back(seen_by_all(colour));
  std::vector<double> nearest(pool.size(), std::numeric_limits<double>::infinity());
  std::size_t counted = 0;
  while (palette.size() < kPaletteSize) {
    for (; counted < taken.size(); ++counted) {
      for (std::size_t i = 0; i < pool.size(); ++i) {
        nearest[i] = std::min(nearest[i], least_difference(seen[i], taken[counted]));
      }
    }
    const auto best =
        static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
    palette.push_back(pool[best]);
    taken.push_back(seen[best]);
  }
  return palette;
}

}  // namespace

Colour material_colour(std::size_t index) {
  static const std::vector<Colour> kPalette = make_palette();
  return kPalette[index % kPalette.size()];
}

Colour material_area_colour(std::size_t index) { return mix(material_colour(index), {1, 1, 1}, 0.45); }

}  // namespace adamas::picture
