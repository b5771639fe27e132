// Compares pictures with those in tests/viewer/golden, which somebody looked at when they were made. Devices
// round differently, so small differences of single pixels, and of edges by one pixel, are tolerated.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>

#include "ball_store.h"
#include "core/base/error.h"
#include "core/picture/canvas.h"
#include "isosurface/view/flight.h"
#include "tests/picture/decode_png.h"
#include "tests/support/scratch.h"
#include "viewer/window/offscreen_pictures.h"

namespace adamas {

using namespace isosurface;
using namespace picture;
using namespace viewer;

namespace {

constexpr int kWidth = 240, kHeight = 180;

/// Returns the mean of a block of pixels round each pixel, in L*a*b*.
LabColour round_pixel(const Raster& raster, int x, int y) {
  LabColour sum;
  int count = 0;
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      if (x + dx < 0 || y + dy < 0 || x + dx >= raster.width() || y + dy >= raster.height()) continue;
      const Raster::Pixel p = raster.at(x + dx, y + dy);
      const LabColour lab = to_lab({p.r / 255.0, p.g / 255.0, p.b / 255.0});
      sum.lightness += lab.lightness;
      sum.a += lab.a;
      sum.b += lab.b;
      ++count;
    }
  }
  return {sum.lightness / count, sum.a / count, sum.b / count};
}

struct Difference {
  double mean = 0, greatest = 0;  ///< in L*a*b*, where a distance of about 2 can just be seen
};

Difference difference(const Raster& one, const Raster& other) {
  Difference result;
  for (int y = 0; y < one.height(); ++y) {
    for (int x = 0; x < one.width(); ++x) {
      const LabColour a = round_pixel(one, x, y), b = round_pixel(other, x, y);
      const double d = std::hypot(a.lightness - b.lightness, a.a - b.a, a.b - b.b);
      result.mean += d / (one.width() * one.height());
      result.greatest = std::max(result.greatest, d);
    }
  }
  return result;
}

/// The parameter says whether surfaces are interpolated by the vertex shader.
class ReferencePictures : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    const std::string path = (folder / "ball.adm").string();
    test::make_ball_store(path);
    DocumentOptions options;
    options.memory = std::size_t{64} << 20;
    options.interpolates_in_shader = GetParam();
    session.open(path, options, SilentProgress::instance());
    session.state().documents[0].surfaces[0].isovalue = 100;
    // Text is left out, since it depends on the fonts of the system.
    session.state().has_axes = session.state().has_colour_bar = false;
    try {
      pictures.emplace(session, kWidth, kHeight);
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
  }

  void expect_reference(const std::string& name) {
    const Raster drawn = pictures->draw(flight(Orbit{1}, session.box(), kWidth, kHeight)[0]).value();
    const std::filesystem::path path =
        std::filesystem::path(ADAMAS_SOURCE_DIR) / "tests/viewer/golden" / (name + ".png");
    // Where this variable is set the pictures are written anew, to be looked at.
    if (std::getenv("ADAMAS_NEW_PICTURES") != nullptr)
      write_png(path, drawn);  // NOLINT(concurrency-mt-unsafe)
    const Difference found = difference(drawn, test::decode_png(test::bytes_of(path)));
    EXPECT_LT(found.mean, 0.2) << name;
    EXPECT_LT(found.greatest, 12) << name;
  }

  test::Scratch folder;
  ViewSession session{kWidth, kHeight};
  std::optional<OffscreenPictures> pictures;
};

INSTANTIATE_TEST_SUITE_P(Interpolation, ReferencePictures, testing::Values(false, true),
                         [](const auto& by) { return by.param ? "ByTheShader" : "ByTheProcessor"; });

TEST_P(ReferencePictures, AreOfWhatIsInterpolatedThere) {
  session.finish();
  std::size_t of_ends = 0, of_vertices = 0;
  for (const DrawnPart& part : session.parts()) {
    if (part.mesh->is_lines) continue;
    of_ends += part.mesh->ends.size();
    of_vertices += part.mesh->vertices.size();
  }
  EXPECT_EQ(of_ends > 0, GetParam());
  EXPECT_EQ(of_vertices > 0, !GetParam());
}

TEST_P(ReferencePictures, LitAndAsASphere) {
  expect_reference("lit");
  session.state().shading = Shading::kSphere;
  expect_reference("sphere");
}

TEST_P(ReferencePictures, TransparentAroundOpaque) {
  DocumentState& state = session.state().documents[0];
  state.surfaces.push_back(state.surfaces[0]);
  state.surfaces[0].opacity = 0.4;
  state.surfaces[1].isovalue = 150;
  state.surfaces[1].colour = {0.3, 0.5, 0.9};
  expect_reference("transparent");
}

TEST_P(ReferencePictures, CutWithEdges) {
  session.state().has_edges = true;
  session.state().cut = {true, {{16, 16, 16}, {1, -0.5, 0.3}}, true, false};
  expect_reference("cut");
}

TEST_P(ReferencePictures, WithASection) {
  session.state().colour_map = "viridis";
  session.state().cut = {true, {{16, 18, 16}, {0.6, -1, 0.3}}, false, true};
  expect_reference("section");
}

TEST_P(ReferencePictures, ADifferenceThatCanBeSeenIsOne) {
  const Viewpoint viewpoint = flight(Orbit{1}, session.box(), kWidth, kHeight)[0];
  const Raster first = pictures->draw(viewpoint).value();
  session.state().documents[0].surfaces[0].isovalue = 97;
  const Difference moved = difference(first, pictures->draw(viewpoint).value());
  EXPECT_GT(moved.mean, 0.2) << "a surface that is a third of a voxel farther out";
  session.state().documents[0].surfaces[0].isovalue = 100;
  session.state().documents[0].surfaces[0].colour = {0.93, 0.80, 0.66};
  EXPECT_GT(difference(first, pictures->draw(viewpoint).value()).mean, 0.2) << "another colour";
}

}  // namespace
}  // namespace adamas
