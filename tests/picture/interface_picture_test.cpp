#include "core/picture/interface_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "decode_png.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace picture;

namespace {

InterfacePicture two_sheets() {
  InterfacePicture picture;
  picture.title = "Interfaces";
  picture.domain = {{0, 0, 0}, {1, 1, 1}};
  picture.direction = {0, 1, 0};
  picture.projection = Projection::kOrthographic;
  const Colour red{1, 0, 0}, green{0, 1, 0};
  // A red sheet is in front of a green one.
  picture.triangles = {{{Vec3{0, 0.2, 0}, Vec3{1, 0.2, 0}, Vec3{1, 0.2, 1}}, red},
                       {{Vec3{0, 0.2, 0}, Vec3{1, 0.2, 1}, Vec3{0, 0.2, 1}}, red},
                       {{Vec3{0, 0.8, 0}, Vec3{1, 0.8, 0}, Vec3{1, 0.8, 1}}, green},
                       {{Vec3{0, 0.8, 0}, Vec3{1, 0.8, 1}, Vec3{0, 0.8, 1}}, green}};
  picture.materials = {{.name = "a | b", .colour = red}};
  return picture;
}

struct Shares {
  double red = 0, green = 0;
};

Shares shares(const InterfacePicture& picture) {
  const InterfacePictureOptions options{.width = 640, .height = 480, .samples = 2};
  const Raster raster = test::decode_png(draw_interfaces(picture, PictureFormat::kPng, options));
  Shares result;
  for (int y = 0; y < raster.height(); ++y) {
    for (int x = 0; x < raster.width(); ++x) {
      const Raster::Pixel& p = raster.at(x, y);
      result.red += p.r > 100 && p.g < 60 && p.b < 60 ? 1 : 0;
      result.green += p.g > 100 && p.r < 60 && p.b < 60 ? 1 : 0;
    }
  }
  const double pixels = static_cast<double>(raster.width()) * raster.height();
  return {result.red / pixels, result.green / pixels};
}

TEST(InterfacePicture, TheNearerSheetHidesTheOther) {
  const Shares found = shares(two_sheets());
  EXPECT_GT(found.red, 0.3);
  EXPECT_EQ(found.green, 0);
  InterfacePicture behind = two_sheets();
  behind.direction = {0, -1, 0};
  const Shares other = shares(behind);
  EXPECT_GT(other.green, 0.3);
  EXPECT_LT(other.red, 5e-5) << "nor in the legend; the axes have a pixel or two";
}

TEST(InterfacePicture, TheLegendNamesWhatIsToBeSeen) {
  InterfacePicture picture = two_sheets();
  picture.materials = {{.name = "seen", .colour = {1, 0, 0}}, {.name = "hidden", .colour = {0, 1, 0}}};
  const std::string svg = draw_interfaces(picture, PictureFormat::kSvg);
  EXPECT_NE(svg.find("seen"), std::string::npos);
  EXPECT_EQ(svg.find("hidden"), std::string::npos);
}

/// Returns the share of pixels that are as dark as outlines.
double dark_share(const InterfacePicture& picture, double crease_angle) {
  const InterfacePictureOptions options{
      .width = 640, .height = 480, .samples = 1, .crease_angle = crease_angle, .axes = false};
  const Raster raster = test::decode_png(draw_interfaces(picture, PictureFormat::kPng, options));
  double dark = 0;
  for (int y = 0; y < raster.height(); ++y) {
    for (int x = 0; x < raster.width(); ++x) {
      const Raster::Pixel& p = raster.at(x, y);
      dark += p.a > 0 && p.r < 70 && p.g < 70 && p.b < 70 ? 1 : 0;
    }
  }
  return dark / (static_cast<double>(raster.width()) * raster.height());
}

TEST(InterfacePicture, StepsOfASurfaceAreNoCreases) {
  InterfacePicture stairs;
  stairs.direction = {1, 0, -1};
  const int steps = 40;
  for (int i = 0; i < steps; ++i) {
    const double at = static_cast<double>(i) / steps, next = static_cast<double>(i + 1) / steps;
    const Colour colour{1, 0.5, 0.5};
    // A step consists of a tread and a riser, both quadrilaterals.
    for (const auto& [p, q] :
         {std::pair(Vec3{at, 0, at}, Vec3{at, 0, next}), std::pair(Vec3{at, 0, next}, Vec3{next, 0, next})}) {
      const Vec3 side{0, 1, 0};
      stairs.triangles.push_back({{p, q, q + side}, colour});
      stairs.triangles.push_back({{p, q + side, p + side}, colour});
    }
  }
  EXPECT_LT(dark_share(stairs, InterfacePictureOptions{}.crease_angle), 0.03);
  EXPECT_GT(dark_share(stairs, 40), 0.1) << "the lines that are left out";
}

TEST(InterfacePicture, OptionsAndEmptyPictures) {
  InterfacePictureOptions options{.width = 320, .height = 240, .samples = 1, .triangle_edges = true};
  const Raster raster = test::decode_png(draw_interfaces(two_sheets(), PictureFormat::kPng, options));
  EXPECT_EQ(raster.width(), 320);
  EXPECT_EQ(raster.height(), 240);
  const Raster empty = test::decode_png(draw_interfaces({}, PictureFormat::kPng, options));
  EXPECT_EQ(empty.width(), 320);
  EXPECT_EQ(empty.at(160, 60), (Raster::Pixel{255, 255, 255, 255})) << "no surface, no box";
  options.samples = 9;
  EXPECT_THROW(draw_interfaces(two_sheets(), PictureFormat::kPng, options), Error);
  InterfacePicture bad = two_sheets();
  bad.triangles[0].points[0].x = INFINITY;
  EXPECT_THROW(draw_interfaces(bad, PictureFormat::kPng), Error);
}

TEST(InterfacePicture, SameBytesEveryTimeInAFile) {
  const test::Scratch folder;
  const InterfacePictureOptions options{.width = 400, .height = 300};
  write_interfaces(two_sheets(), folder / "a.png", options);
  EXPECT_EQ(test::bytes_of(folder / "a.png"), draw_interfaces(two_sheets(), PictureFormat::kPng, options));
  EXPECT_THROW(write_interfaces(two_sheets(), folder / "none" / "a.png", options), Error);
  EXPECT_EQ(folder.entries(), 1);
}

}  // namespace
}  // namespace adamas
