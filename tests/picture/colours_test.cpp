#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/picture/colour_map.h"
#include "core/picture/material_colours.h"

namespace adamas {

using namespace picture;

namespace {

// Returns CIE L* of an sRGB colour, by the formulas of the standards.
double lightness(const Colour& c) {
  const auto linear = [](double v) { return v > 0.04045 ? std::pow((v + 0.055) / 1.055, 2.4) : v / 12.92; };
  const double y = 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
  return y > 0.008856451679 ? 116 * std::pow(y, 1.0 / 3) - 16 : 903.2962962963 * y;
}

bool in_gamut(const Colour& c) {
  return c.r >= 0 && c.r <= 1 && c.g >= 0 && c.g <= 1 && c.b >= 0 && c.b <= 1;
}

double difference(const Colour& p, const Colour& q) {
  const LabColour a = to_lab(p), b = to_lab(q);
  return std::sqrt((a.lightness - b.lightness) * (a.lightness - b.lightness) + (a.a - b.a) * (a.a - b.a) +
                   (a.b - b.b) * (a.b - b.b));
}

TEST(Colours, LabKnowsThePrimaries) {
  // These are published values of the sRGB primaries under D65.
  const LabColour white = to_lab({1, 1, 1}), red = to_lab({1, 0, 0}), blue = to_lab({0, 0, 1});
  EXPECT_NEAR(white.lightness, 100, 1e-6);
  EXPECT_NEAR(std::hypot(white.a, white.b), 0, 0.02);
  EXPECT_NEAR(red.lightness, 53.24, 0.02);
  EXPECT_NEAR(red.a, 80.09, 0.05);
  EXPECT_NEAR(red.b, 67.20, 0.05);
  EXPECT_NEAR(blue.lightness, 32.30, 0.02);
  EXPECT_NEAR(blue.a, 79.19, 0.05);
  EXPECT_NEAR(blue.b, -107.86, 0.05);
}

TEST(Colours, LabThereAndBack) {
  for (double r = 0; r <= 1; r += 0.125) {
    for (double g = 0; g <= 1; g += 0.125) {
      for (double b = 0; b <= 1; b += 0.125) {
        const Colour back = from_lab(to_lab({r, g, b}));
        EXPECT_NEAR(back.r, r, 1e-4);
        EXPECT_NEAR(back.g, g, 1e-4);
        EXPECT_NEAR(back.b, b, 1e-4);
      }
    }
  }
}

TEST(Colours, WhatCannotBeShownKeepsItsLightness) {
  for (int hue = 0; hue < 360; hue += 10) {
    const Colour c = from_lch(60, 200, hue);
    EXPECT_TRUE(in_gamut(c));
    EXPECT_NEAR(lightness(c), 60, 0.01) << hue;
  }
}

TEST(ColourMaps, LightnessRisesInTheSequentialAndTheGreyMap) {
  for (const ColourMap& map : {ColourMap::sequential(), ColourMap::grey()}) {
    double last = -1;
    for (int i = 0; i <= 1000; ++i) {
      const Colour c = map.at(i / 1000.0);
      ASSERT_TRUE(in_gamut(c));
      const double now = lightness(c);
      EXPECT_GT(now, last) << i;
      last = now;
    }
    EXPECT_GT(last, 90);
    EXPECT_LT(lightness(map.at(0)), 16);
  }
}

TEST(ColourMaps, DivergingMapIsLightestInTheMiddleAndSymmetric) {
  const ColourMap map = ColourMap::diverging();
  EXPECT_GT(lightness(map.at(0.5)), 85);
  EXPECT_NEAR(lightness(map.at(0)), lightness(map.at(1)), 1);
  double peak = 0, at = 0;
  for (int i = 0; i <= 1000; ++i) {
    if (const double l = lightness(map.at(i / 1000.0)); l > peak) peak = l, at = i / 1000.0;
  }
  EXPECT_NEAR(at, 0.5, 0.002);
  for (int i = 0; i < 1000; ++i) {
    const double step = lightness(map.at((i + 1) / 1000.0)) - lightness(map.at(i / 1000.0));
    if (i < 490) {
      EXPECT_GT(step, 0) << i;
    }
    if (i > 510) {
      EXPECT_LT(step, 0) << i;
    }
  }
}

TEST(ColourMaps, EqualStepsOfOurOwnLookEqual) {
  for (const char* name : {"sequential", "diverging", "grey"}) {
    const ColourMap map = ColourMap::by_name(name);
    double least = 1e9, greatest = 0;
    for (int i = 0; i < 256; ++i) {
      const double step = difference(map.at(i / 256.0), map.at((i + 1) / 256.0));
      least = std::min(least, step), greatest = std::max(greatest, step);
    }
    EXPECT_LT(greatest / least, 1.15) << name;
  }
}

TEST(ColourMaps, KnownOnesHaveTheirColours) {
  const auto near = [](const std::string& name, double t, const Colour& wanted) {
    const Colour found = ColourMap::by_name(name).at(t);
    EXPECT_LT(std::abs(found.r - wanted.r) + std::abs(found.g - wanted.g) + std::abs(found.b - wanted.b),
              0.08)
        << name << ' ' << t;
  };
  // These are the values of matplotlib and ParaView.
  near("viridis", 0, {0.267, 0.005, 0.329});
  near("viridis", 0.5, {0.128, 0.567, 0.551});
  near("viridis", 1, {0.993, 0.906, 0.144});
  near("magma", 0.5, {0.716, 0.215, 0.475});
  near("inferno", 0.5, {0.736, 0.216, 0.330});
  near("plasma", 0.5, {0.798, 0.280, 0.470});
  near("cividis", 0.5, {0.486, 0.482, 0.472});
  near("cool-warm", 0.5, {0.865, 0.865, 0.865});
  for (const std::string& name : ColourMap::names()) {
    const ColourMap map = ColourMap::by_name(name);
    for (int i = 0; i <= 256; ++i) ASSERT_TRUE(in_gamut(map.at(i / 256.0))) << name;
  }
}

TEST(ColourMaps, OutsideAndMissingValues) {
  const ColourMap map = ColourMap::sequential();
  EXPECT_EQ(map.at(-3), map.at(0));
  EXPECT_EQ(map.at(INFINITY), map.at(1));
  EXPECT_EQ(map.at(NAN), ColourMap::no_data());
  for (int i = 0; i <= 256; ++i) EXPECT_GT(difference(map.at(i / 256.0), ColourMap::no_data()), 10) << i;
  EXPECT_THROW(ColourMap::by_name("rainbow"), Error);
}

std::vector<Colour> first_colours(std::size_t count) {
  std::vector<Colour> colours;
  for (std::size_t i = 0; i < count; ++i) colours.push_back(material_colour(i));
  return colours;
}

TEST(Palette, ColoursDifferForAllEyes) {
  const std::vector<Colour> palette = first_colours(12);
  for (std::size_t i = 0; i < palette.size(); ++i) {
    EXPECT_GT(difference(palette[i], {1, 1, 1}), 15);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(difference(palette[i], palette[j]), 20) << i << " " << j;
      for (const Vision vision : {Vision::kProtanope, Vision::kDeuteranope}) {
        EXPECT_GT(difference(seen_by(vision, palette[i]), seen_by(vision, palette[j])), 9) << i << " " << j;
      }
    }
  }
}

TEST(Palette, AsManyAsAskedFor) {
  std::set<std::array<std::uint8_t, 3>> different;
  for (const Colour& c : first_colours(kPaletteSize)) different.insert(to_bytes(c));
  EXPECT_EQ(different.size(), kPaletteSize);
  EXPECT_EQ(material_colour(3), material_colour(3 + kPaletteSize));
}

}  // namespace
}  // namespace adamas
