#include "core/picture/interface_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/picture/png.h"
#include "scratch_folder.h"

namespace adamas {
namespace {

InterfacePicture two_sheets() {
  InterfacePicture picture;
  picture.title = "Interfaces";
  picture.domain = {{0, 0, 0}, {1, 1, 1}};
  picture.direction = {0, 1, 0};
  picture.projection = Projection::kOrthographic;
  const Colour red{1, 0, 0}, green{0, 1, 0};
  // A red sheet in front of a green one.
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
  const Raster raster = decode_png(draw_interfaces(picture, PictureFormat::kPng, options));
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
  EXPECT_LT(other.red, 0.001) << "the legend's square alone";
}

TEST(InterfacePicture, CutAwayRemovesOneSide) {
  InterfacePicture picture = two_sheets();
  picture.cut_away = CutAway{{0, 0.5, 0}, {0, -1, 0}};
  const Shares found = shares(picture);
  EXPECT_LT(found.red, 0.001);
  EXPECT_GT(found.green, 0.3);
}

TEST(InterfacePicture, OptionsAndEmptyPictures) {
  InterfacePictureOptions options{.width = 320, .height = 240, .samples = 1, .triangle_edges = true};
  const Raster raster = decode_png(draw_interfaces(two_sheets(), PictureFormat::kPng, options));
  EXPECT_EQ(raster.width(), 320);
  EXPECT_EQ(raster.height(), 240);
  EXPECT_FALSE(draw_interfaces({}, PictureFormat::kPng, options).empty());
  options.samples = 9;
  EXPECT_THROW(draw_interfaces(two_sheets(), PictureFormat::kPng, options), Error);
  InterfacePicture bad = two_sheets();
  bad.triangles[0].points[0].x = INFINITY;
  EXPECT_THROW(draw_interfaces(bad, PictureFormat::kPng), Error);
}

TEST(InterfacePicture, SameBytesEveryTimeInAFile) {
  const ScratchFolder folder;
  const InterfacePictureOptions options{.width = 400, .height = 300};
  write_interfaces(two_sheets(), folder.path() / "a.png", options);
  EXPECT_EQ(bytes_of(folder.path() / "a.png"), draw_interfaces(two_sheets(), PictureFormat::kPng, options));
  EXPECT_THROW(write_interfaces(two_sheets(), folder.path() / "none" / "a.png", options), Error);
  EXPECT_EQ(folder.files(), 1u);
}

}  // namespace
}  // namespace adamas
