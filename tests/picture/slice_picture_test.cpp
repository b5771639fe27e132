#include "core/picture/slice_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/picture/material_colours.h"
#include "core/picture/slice_contents.h"
#include "decode_png.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace picture;

namespace {

SlicePicture three_panels() {
  SlicePicture picture;
  picture.title = "Density <of> the \"impact\" & more";
  picture.x_label = "y [cm]";
  picture.y_label = "z [cm]";
  picture.field_label = "density [g/cm³]";
  const FieldPolygon left{{{0, 0}, {1, 0}, {1, 2}, {0, 2}}, {0, 1, 1, 0}},
      right{{{1, 0}, {2, 0}, {2, 2}, {1, 2}}, {1, 2, 2, 1}};
  const LineSet lines{"original interface", original_interface_stroke(), {{1, 0}, {1, 2}}};
  picture.panels = {
      {"Input", {left, right}, {lines}}, {"Plain", {left, right}, {}}, {"Per material", {left}, {lines}}};
  picture.materials = {{.name = "projectile", .colour = material_colour(0)}};
  return picture;
}

// Returns the bounding rectangle of all pixels of one colour. It finds areas without knowledge of the layout.
Box2 extent_of(const Raster& raster, const Colour& colour) {
  const auto bytes = to_bytes(colour);
  Box2 box;
  for (int y = 0; y < raster.height(); ++y) {
    for (int x = 0; x < raster.width(); ++x) {
      if (raster.at(x, y) == Raster::Pixel{bytes[0], bytes[1], bytes[2], 255}) {
        box.extend({static_cast<double>(x), static_cast<double>(y)});
        box.extend({x + 1.0, y + 1.0});
      }
    }
  }
  return box;
}

TEST(SlicePicture, AreasKeepTheirProportionsAndPlaces) {
  const Colour a{0.2, 0.4, 0.6}, b{0.6, 0.4, 0.2};
  SlicePicture picture;
  picture.window = Box2{{0, 0}, {4, 3}};
  picture.panels = {
      {"", {{{{1, 1}, {3, 1}, {3, 2}, {1, 2}}, {}, a}, {{{0, 2}, {4, 2}, {4, 3}, {0, 3}}, {}, b}}, {}}};
  const Raster raster = test::decode_png(draw_slice(picture, PictureFormat::kPng));
  const Vec2 inner = extent_of(raster, a).size(), upper = extent_of(raster, b).size();
  EXPECT_NEAR(inner.x / inner.y, 2, 0.02);
  EXPECT_NEAR(upper.x / inner.x, 2, 0.02);
  EXPECT_LT(extent_of(raster, b).max.y, extent_of(raster, a).min.y + 2) << "greater ordinates lie higher";
}

TEST(SlicePicture, FieldValuesTakeTheColoursOfTheMap) {
  for (const double value : {0.0, 0.25, 1.0}) {
    SlicePicture picture;
    picture.range = ValueRange{0, 1};
    picture.panels = {{"", {{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {value, value, value, value}}}, {}}};
    const Raster raster = test::decode_png(draw_slice(picture, PictureFormat::kPng, {.width = 600}));
    const Vec2 size = extent_of(raster, picture.map.at(value)).size();
    EXPECT_GT(size.x, 300) << value;
    EXPECT_GT(size.y, 300) << value;
  }
}

TEST(SlicePicture, IsAsWideAsAskedForAndNeverTallerThanAllowed) {
  for (const double width : {600.0, 1600.0, 2400.0}) {
    const Raster raster = test::decode_png(
        draw_slice(three_panels(), PictureFormat::kPng, {.width = width, .greatest_height = 5000}));
    EXPECT_LE(raster.width(), width);
    EXPECT_GT(raster.width(), 0.97 * width);
  }
  const Raster low = test::decode_png(
      draw_slice(three_panels(), PictureFormat::kPng, {.width = 1600, .greatest_height = 500}));
  EXPECT_LE(low.height(), 520);
}

TEST(SlicePicture, LettersOfSmallPicturesAreNotSmall) {
  SlicePicture picture;
  picture.title = "H";
  picture.panels.resize(1);
  for (const double width : {200.0, 300.0, 800.0}) {
    const Raster raster = test::decode_png(
        draw_slice(picture, PictureFormat::kPng, {.width = width, .greatest_height = width}));
    // The title stands alone in the upper left corner, above the panel.
    int least = raster.height(), greatest = -1;
    for (int y = 0; y < 30; ++y) {
      for (int x = 0; x < 30; ++x) {
        if (raster.at(x, y).r > 100) continue;
        least = std::min(least, y);
        greatest = std::max(greatest, y);
      }
    }
    EXPECT_GE(greatest - least + 1, 9) << width;
  }
}

TEST(SlicePicture, WhatThereIsNoRoomForIsLeftOut) {
  const auto shows = [](double side, const char* text) {
    const std::string svg =
        draw_slice(three_panels(), PictureFormat::kSvg, {.width = side, .greatest_height = side});
    return svg.find(text) != std::string::npos;
  };
  for (const char* text : {"y [cm]", "density [g/cm³]"}) {
    EXPECT_TRUE(shows(1600, text)) << text;
    EXPECT_FALSE(shows(300, text)) << text;
  }
  const Raster small = test::decode_png(
      draw_slice(three_panels(), PictureFormat::kPng, {.width = 250, .greatest_height = 250}));
  EXPECT_LE(small.width(), 250);
  EXPECT_LE(small.height(), 260);
}

TEST(SlicePicture, SvgHoldsTheTexts) {
  const std::string svg = draw_slice(three_panels(), PictureFormat::kSvg);
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_NE(svg.find("<title>Density &lt;of&gt; the &quot;impact&quot; &amp; more</title>"),
            std::string::npos);
  for (const char* text : {"Input", "Plain", "Per material", "y [cm]", "z [cm]", "density [g/cm³]",
                           "original interface", "projectile"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  EXPECT_NE(svg.find("<image"), std::string::npos) << "the field is embedded as an image";
}

TEST(SlicePicture, PdfIsWholeAndNamesItsTitle) {
  SlicePicture picture = three_panels();
  picture.title = "Density";
  const std::string pdf = draw_slice(picture, PictureFormat::kPdf);
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  EXPECT_NE(pdf.find("%%EOF"), std::string::npos);
  EXPECT_NE(pdf.find("/Title (Density)"), std::string::npos);
}

TEST(SlicePicture, SameBytesEveryTime) {
  for (const PictureFormat format : {PictureFormat::kPng, PictureFormat::kSvg, PictureFormat::kPdf}) {
    const std::string first = draw_slice(three_panels(), format, {.width = 800}),
                      second = draw_slice(three_panels(), format, {.width = 800});
    EXPECT_TRUE(first == second);
    EXPECT_EQ(first.find("CreationDate (D:202"), std::string::npos);
  }
}

TEST(SlicePicture, SharedEdgesAreDrawnOnce) {
  const Vec2 a{0, 0}, b{1, 0.5}, c{0.5, 2};
  const std::vector<Vec2> points{a, b, b, c, b, a, a, b, c, b};
  EXPECT_EQ(shown_segments(points, {{0, 0}, {3, 3}}).size(), 2u);
  EXPECT_EQ(shown_segments(points, {{0, 0}, {0.2, 3}}).size(), 1u);
  SlicePicture once, twice;
  once.panels = {{"", {}, {{"", cell_stroke(), {a, b, b, c}}}}};
  twice.panels = {{"", {}, {{"", cell_stroke(), points}}}};
  EXPECT_TRUE(draw_slice(once, PictureFormat::kPng, {.width = 400}) ==
              draw_slice(twice, PictureFormat::kPng, {.width = 400}));
}

TEST(SlicePicture, AnEmptyPanelIsWhite) {
  SlicePicture empty;
  empty.panels.resize(1);
  const Raster raster = test::decode_png(draw_slice(empty, PictureFormat::kPng, {.width = 600}));
  EXPECT_GT(raster.width(), 500);
  EXPECT_EQ(raster.at(raster.width() / 2, raster.height() / 2), (Raster::Pixel{255, 255, 255, 255}));
}

TEST(SlicePicture, OddContents) {
  SlicePicture odd = three_panels();
  odd.title = std::string(500, 'W') + "\xff\x01";
  odd.panels[0].title = "\xc3";
  odd.panels[0].polygons[0].values = {NAN, INFINITY, 1, 1};
  odd.panels[0].polygons.push_back({{{0, 0}, {1e9, 1e9}}, {1, 2}});
  odd.panels[0].lines.push_back({"far away", cell_stroke(), {{-1e15, -1e15}, {1e15, 1.1e15}, {7, 7}}});
  odd.window = Box2{{0, 0}, {2, 2}};
  const std::string svg = draw_slice(odd, PictureFormat::kSvg, {.width = 800});
  EXPECT_NE(svg.find("no data"), std::string::npos);
  EXPECT_EQ(svg.find('\xff'), std::string::npos) << "no byte that XML cannot have";
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_NE(draw_slice(odd, PictureFormat::kPdf, {.width = 800}).find("%%EOF"), std::string::npos);
  const Raster raster = test::decode_png(draw_slice(odd, PictureFormat::kPng, {.width = 800}));
  EXPECT_LE(raster.width(), 800);
  EXPECT_FALSE(extent_of(raster, ColourMap::no_data()).empty()) << "the polygon without numbers";
}

TEST(SlicePicture, ThinContentsStillShowTheirLine) {
  for (const double thin : {0.0, 1e-12, 1e12}) {
    SlicePicture line;
    Stroke stroke = cell_stroke();
    stroke.colour = {1, 0, 1};
    stroke.width = 4;
    stroke.opacity = 1;
    line.panels = {{"", {}, {{"", stroke, {{0, 0}, {1, thin}}}}}};
    const Raster raster = test::decode_png(draw_slice(line, PictureFormat::kPng, {.width = 400}));
    int pixels = 0;
    for (int y = 0; y < raster.height(); ++y) {
      for (int x = 0; x < raster.width(); ++x) pixels += raster.at(x, y).r > raster.at(x, y).g + 100 ? 1 : 0;
    }
    EXPECT_GT(pixels, 100) << thin;
  }
}

TEST(SlicePicture, BadInputIsAnError) {
  EXPECT_THROW(draw_slice({}, PictureFormat::kPng), Error);
  SlicePicture picture = three_panels();
  picture.panels[1].polygons[0].values.pop_back();
  EXPECT_THROW(draw_slice(picture, PictureFormat::kPng), Error);
  picture = three_panels();
  picture.panels[0].lines[0].points[0].x = NAN;
  EXPECT_THROW(draw_slice(picture, PictureFormat::kPng), Error);
  picture = three_panels();
  picture.range = ValueRange{1, -1};
  EXPECT_THROW(draw_slice(picture, PictureFormat::kPng), Error);
  EXPECT_THROW(draw_slice(three_panels(), PictureFormat::kPng, {.width = 1e6}), Error);
  EXPECT_THROW(draw_slice(three_panels(), PictureFormat::kPng, {.width = NAN}), Error);
}

TEST(SlicePicture, FilesAreWholeOrAbsent) {
  const test::Scratch folder;
  for (const char* name : {"a.png", "b.SVG", "c.pdf"}) {
    write_slice(three_panels(), folder / name);
    EXPECT_GT(std::filesystem::file_size(folder / name), 1000u);
  }
  EXPECT_EQ(test::bytes_of(folder / "a.png"), draw_slice(three_panels(), PictureFormat::kPng));
  EXPECT_THROW(write_slice(three_panels(), folder / "d.jpg"), Error);
  EXPECT_THROW(write_slice(three_panels(), folder / "missing" / "d.png"), Error);
  EXPECT_EQ(folder.entries(), 3);
}

TEST(SlicePicture, AFrameHasThePixelsOfThePng) {
  const SlicePicture picture = three_panels();
  const Raster png = test::decode_png(draw_slice(picture, PictureFormat::kPng)),
               frame = draw_slice_frame(picture);
  ASSERT_EQ(frame.width(), png.width());
  ASSERT_EQ(frame.height(), png.height());
  int different = 0;
  for (int y = 0; y < png.height(); ++y) {
    for (int x = 0; x < png.width(); ++x) different += frame.at(x, y) == png.at(x, y) ? 0 : 1;
  }
  EXPECT_EQ(different, 0);
}

}  // namespace
}  // namespace adamas
