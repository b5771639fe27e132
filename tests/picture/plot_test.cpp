#include "core/picture/plot.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <string>

#include "core/base/error.h"
#include "core/picture/axes.h"
#include "decode_png.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace picture;

namespace {

Plot error_plot() {
  Plot plot;
  plot.title = "Error";
  plot.x = {.label = "tetrahedra", .kind = AxisKind::kLogarithmic};
  plot.y = {.label = "error [cm]", .kind = AxisKind::kLogarithmic};
  plot.series = {{.name = "adamas", .x = {100, 1000, 10000}, .y = {1, 0.3, 0.1}},
                 {.name = "peer", .x = {200, 4000}, .y = {2, 0.9}, .dashed = true}};
  return plot;
}

// Returns the centres of connected areas of one pure colour, such as markers, from left to right.
std::vector<Vec2> blobs(const Raster& raster, const Colour& colour, double gap) {
  const auto bytes = to_bytes(colour);
  std::vector<Vec2> centres;
  Vec2 sum{};
  int count = 0, last = -1000;
  for (int x = 0; x < raster.width(); ++x) {
    for (int y = 0; y < raster.height(); ++y) {
      if (!(raster.at(x, y) == Raster::Pixel{bytes[0], bytes[1], bytes[2], 255})) continue;
      if (x - last > gap && count > 0) centres.push_back((1.0 / count) * sum), sum = {}, count = 0;
      sum = sum + Vec2{x + 0.5, y + 0.5}, ++count, last = x;
    }
  }
  if (count > 0) centres.push_back((1.0 / count) * sum);
  return centres;
}

/// Returns the box round the pixels of nearly one colour; empty (min > max) where there are none.
Box2 box_of(const Raster& raster, const Colour& colour) {
  const auto bytes = to_bytes(colour);
  const auto near = [](int a, int b) { return std::abs(a - b) < 40; };
  Box2 box;
  for (int y = 0; y < raster.height(); ++y) {
    for (int x = 0; x < raster.width(); ++x) {
      const Raster::Pixel& p = raster.at(x, y);
      if (near(p.r, bytes[0]) && near(p.g, bytes[1]) && near(p.b, bytes[2]))
        box.extend({static_cast<double>(x), static_cast<double>(y)});
    }
  }
  return box;
}

TEST(Plot, SideBySideEachIsAsItIsAlone) {
  Plot other = error_plot();
  other.title = "Seconds";
  other.y.label = "seconds";
  other.series[0].y = {5, 60, 800};
  const std::array plots{error_plot(), other};
  const PlotOptions options{.width = 500, .height = 400};
  const Raster both = test::decode_png(draw_plots(plots, PictureFormat::kPng, options));
  ASSERT_EQ(both.width(), 1000);
  ASSERT_EQ(both.height(), 400);
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const Raster alone = test::decode_png(draw_plot(plots[i], PictureFormat::kPng, options));
    int different = 0;
    for (int y = 0; y < 400; ++y) {
      for (int x = 0; x < 500; ++x)
        different += both.at(x + 500 * static_cast<int>(i), y) == alone.at(x, y) ? 0 : 1;
    }
    EXPECT_EQ(different, 0) << "plot " << i;
  }
}

TEST(Plot, InRowsEachIsAsItIsAlone) {
  std::vector<Plot> plots(3, error_plot());
  for (std::size_t i = 0; i < plots.size(); ++i)
    plots[i].series[0].y = {5.0 + static_cast<double>(i), 60, 800};
  const PlotOptions options{.width = 500, .height = 400, .columns = 2};
  const Raster all = test::decode_png(draw_plots(plots, PictureFormat::kPng, options));
  ASSERT_EQ(all.width(), 1000);
  ASSERT_EQ(all.height(), 800);
  for (int i = 0; i < 3; ++i) {
    const Raster alone =
        test::decode_png(draw_plot(plots[static_cast<std::size_t>(i)], PictureFormat::kPng, options));
    int different = 0;
    for (int y = 0; y < 400; ++y) {
      for (int x = 0; x < 500; ++x)
        different += all.at(x + 500 * (i % 2), y + 400 * (i / 2)) == alone.at(x, y) ? 0 : 1;
    }
    EXPECT_EQ(different, 0) << "plot " << i;
  }
}

TEST(Plot, MarkersLieWhereTheValuesSay) {
  for (const bool logarithmic : {false, true}) {
    Plot plot;
    const Colour colour{1, 0, 1};
    if (logarithmic) plot.x.kind = plot.y.kind = AxisKind::kLogarithmic;
    const std::vector<double> x{1, 20, 60, 100}, y{5, 90, 10, 50};
    plot.series = {{.x = x, .y = y, .line = false, .colour = colour}};
    const std::vector<Vec2> found = blobs(test::decode_png(draw_plot(plot, PictureFormat::kPng)), colour, 3);
    ASSERT_EQ(found.size(), x.size());
    const auto scaled = [&](double v) { return logarithmic ? std::log(v) : v; };
    // The first and the last point fix the scales, the others must fit.
    const double sx = (found[3].x - found[0].x) / (scaled(x[3]) - scaled(x[0]));
    const double sy = (found[3].y - found[0].y) / (scaled(y[3]) - scaled(y[0]));
    EXPECT_GT(sx, 0);
    EXPECT_LT(sy, 0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_NEAR(found[i].x, found[0].x + sx * (scaled(x[i]) - scaled(x[0])), 0.7);
      EXPECT_NEAR(found[i].y, found[0].y + sy * (scaled(y[i]) - scaled(y[0])), 0.7);
    }
  }
}

TEST(Plot, PointsThatCannotBeShownAreLeftOut) {
  Plot plot = error_plot();
  const Colour colour{1, 0, 1};
  plot.series = {{.x = {1, 10, 100, -5, 1000}, .y = {1, 0, 2, 3, NAN}, .line = false, .colour = colour}};
  EXPECT_EQ(blobs(test::decode_png(draw_plot(plot, PictureFormat::kPng)), colour, 3).size(), 2u);
  plot.series[0].y = {NAN, NAN, NAN, NAN, NAN};
  EXPECT_EQ(blobs(test::decode_png(draw_plot(plot, PictureFormat::kPng)), colour, 3).size(), 0u);
}

TEST(Plot, LinesAreClippedToTheRange) {
  Vec2 a{-5, 0.5}, b{5, 0.5};
  ASSERT_TRUE(clip_segment({{0, 0}, {1, 1}}, a, b));
  EXPECT_EQ(a, (Vec2{0, 0.5}));
  EXPECT_EQ(b, (Vec2{1, 0.5}));
  a = {-1, 0.5}, b = {0.5, 2.1};
  EXPECT_FALSE(clip_segment({{0, 0}, {1, 1}}, a, b));
  // Outside the frame, a line that runs far beyond it colours no pixels: these are the same as with empty
  // axes.
  Plot plot = error_plot();
  const Colour colour{1, 0, 1};
  plot.x = {.low = 1, .high = 2};
  plot.y = {.low = 1, .high = 2};
  plot.series = {{.x = {1, 1, 2, 2, 1}, .y = {1, 2, 2, 1, 1}, .markers = false, .colour = colour}};
  const Box2 frame = box_of(test::decode_png(draw_plot(plot, PictureFormat::kPng)), colour);
  plot.series[0].x = {-50, 50}, plot.series[0].y = {-50, 50};
  const Box2 diagonal = box_of(test::decode_png(draw_plot(plot, PictureFormat::kPng)), colour);
  for (const bool lower : {true, false}) {
    const Vec2 &expected = lower ? frame.min : frame.max, &found = lower ? diagonal.min : diagonal.max;
    EXPECT_NEAR(found.x, expected.x, 4);
    EXPECT_NEAR(found.y, expected.y, 4);
  }
  plot.series[0].x = {-50, 0}, plot.series[0].y = {1.5, 1.5};
  EXPECT_GT(box_of(test::decode_png(draw_plot(plot, PictureFormat::kPng)), colour).min.x,
            box_of(test::decode_png(draw_plot(plot, PictureFormat::kPng)), colour).max.x)
      << "all of it lies outside";
}

TEST(Plot, AllFormats) {
  EXPECT_EQ(draw_plot(error_plot(), PictureFormat::kPdf).substr(0, 5), "%PDF-");
  const std::string svg = draw_plot(error_plot(), PictureFormat::kSvg);
  for (const char* text : {"Error", "tetrahedra", "error [cm]", "adamas", "peer", "10³"})
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  EXPECT_EQ(svg, draw_plot(error_plot(), PictureFormat::kSvg));
}

TEST(Plot, BadInputIsAnError) {
  Plot plot = error_plot();
  plot.series[0].y.pop_back();
  EXPECT_THROW(draw_plot(plot, PictureFormat::kPng), Error);
  plot = error_plot();
  plot.x.low = 0;
  EXPECT_THROW(draw_plot(plot, PictureFormat::kPng), Error);
  plot = error_plot();
  plot.y.low = 3, plot.y.high = 3;
  EXPECT_THROW(draw_plot(plot, PictureFormat::kPng), Error);
  EXPECT_THROW(draw_plot(error_plot(), PictureFormat::kPng, {.width = 10}), Error);
}

TEST(Plot, EverySeriesHasAMarkerOfItsOwn) {
  Plot plot;
  plot.x = {.low = 0.0, .high = 13.0};
  plot.y = {.low = 0.0, .high = 2.0};
  const Colour colour{0, 0, 0.5};
  for (int n = 0; n < 12; ++n) {
    // Series without markers use up no marker.
    plot.series.push_back({.x = {1, 2}, .y = {0.1, 0.1}, .markers = false});
    plot.series.push_back({.x = {n + 1.0}, .y = {1}, .line = false, .colour = colour});
  }
  const Raster raster =
      test::decode_png(draw_plot(plot, PictureFormat::kPng, {.width = 2600, .height = 600}));
  const std::vector<Vec2> centres = blobs(raster, colour, 60);
  ASSERT_EQ(centres.size(), 12u);
  std::set<std::string> shapes;
  const auto bytes = to_bytes(colour);
  for (int n = 0; n < 12; ++n) {
    const int at_x = static_cast<int>(centres[0].x + (centres[11].x - centres[0].x) * n / 11);
    const int at_y = static_cast<int>(centres[0].y);
    std::string shape;
    for (int y = at_y - 18; y <= at_y + 18; ++y) {
      for (int x = at_x - 18; x <= at_x + 18; x += 2)
        shape += raster.at(x, y) == Raster::Pixel{bytes[0], bytes[1], bytes[2], 255} ? '#' : '.';
      shape += '\n';
    }
    EXPECT_TRUE(shapes.insert(shape).second) << n << "\n" << shape;
  }
}

TEST(Plot, OpenMarkersAreSeenRoundFilledOnes) {
  const Colour inner{0, 0, 0.5}, outer{0.8, 0, 0};
  Plot plot;
  plot.series = {{.x = {1}, .y = {1}, .colour = outer, .marker = 1, .open = true},
                 {.x = {1}, .y = {1}, .colour = inner, .marker = 1}};
  const Raster raster = test::decode_png(draw_plot(plot, PictureFormat::kPng));
  const Box2 filled = box_of(raster, inner), open = box_of(raster, outer);
  EXPECT_LT(open.min.x, filled.min.x);
  EXPECT_GT(open.max.x, filled.max.x);
  EXPECT_LT(open.min.y, filled.min.y);
  EXPECT_GT(open.max.y, filled.max.y);
}

}  // namespace
}  // namespace adamas
