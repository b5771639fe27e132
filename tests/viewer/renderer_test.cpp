#include "viewer/gl/renderer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/base/error.h"
#include "viewer/contents/surface_worker.h"
#include "viewer/gl/offscreen_context.h"
#include "viewer/gl/picture_target.h"

namespace adamas {

using namespace isosurface;
using namespace picture;
using namespace viewer;

namespace {

/// Returns a ball of radius 1 about a point, with its normals.
TriangleSurface ball(const Vec3& middle, int rings = 48) {
  TriangleSurface surface;
  const int around = 2 * rings;
  for (int r = 0; r <= rings; ++r) {
    for (int a = 0; a < around; ++a) {
      const double t = std::numbers::pi * r / rings, f = 2 * std::numbers::pi * a / around;
      const Vec3 n{std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t)};
      surface.points.push_back(middle + n);
      surface.normals.push_back(n);
    }
  }
  const auto at = [&](int r, int a) { return static_cast<std::uint32_t>(r * around + a % around); };
  for (int r = 0; r < rings; ++r) {
    for (int a = 0; a < around; ++a) {
      surface.triangles.push_back({at(r, a), at(r + 1, a), at(r + 1, a + 1)});
      surface.triangles.push_back({at(r, a), at(r + 1, a + 1), at(r, a + 1)});
    }
  }
  return surface;
}

bool is_background(const Raster::Pixel& p) { return p.r > 250 && p.g > 250 && p.b > 250; }

class Pictures : public testing::Test {
 protected:
  void SetUp() override {
    try {
      context.emplace();
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
  }

  Viewpoint viewpoint() const {
    Viewpoint result;
    result.eye = middle + Vec3{3, -4, 2};
    result.target = middle;
    result.up = {0, 0, 1};
    result.near = 0.1;
    return result;
  }

  /// Returns a picture of some parts, of this size and from this viewpoint.
  static Raster draw(Renderer& renderer, const std::vector<DrawnPart>& parts, const Viewpoint& from,
                     int width, int height, Shading shading = Shading::kLit,
                     const std::optional<Plane>& clip = {}) {
    PictureContents contents;
    contents.viewpoint = from;
    contents.parts = parts;
    contents.shading = shading;
    contents.clip = clip;
    const PictureTarget target(width, height);
    renderer.draw(contents, target.framebuffer(), width, height);
    return target.read();
  }
  static DrawnPart part(const TriangleSurface& surface, const Colour& colour = {0.9, 0.8, 0.7}) {
    DrawnPart result{drawn_mesh(surface), {}};
    result.style.front = result.style.back = colour;
    return result;
  }

  std::optional<OffscreenContext> context;
  const Vec3 middle{1000, -2000, 500};  ///< so far from the origin that single precision has few digits left
};

TEST_F(Pictures, ShowsABallWhereItIs) {
  constexpr int kWidth = 320, kHeight = 240;
  Renderer renderer;
  const std::vector<DrawnPart> parts{part(ball(middle))};
  for (const double height : {0.0, 4.0}) {
    Viewpoint from = viewpoint();
    from.height = height;
    const double distance = norm(Vec3{3, -4, 2});
    // This is the radius of the ball's outline, in pixels.
    const double radius =
        height > 0 ? kHeight / height
                   : kHeight / (2 * std::tan(from.field_of_view / 2)) / std::sqrt(distance * distance - 1);
    for (const Shading shading : {Shading::kLit, Shading::kSphere}) {
      const Raster raster = draw(renderer, parts, from, kWidth, kHeight, shading);
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const double r = std::hypot(x + 0.5 - kWidth / 2.0, y + 0.5 - kHeight / 2.0);
          if (r < radius - 1.5) {
            ASSERT_FALSE(is_background(raster.at(x, y))) << x << ' ' << y;
          } else if (r > radius + 1.5) {
            ASSERT_TRUE(is_background(raster.at(x, y))) << x << ' ' << y;
          }
        }
      }
      // The light comes from above on the left, and silhouettes are dark.
      const auto brightness = [&](double dx, double dy) {
        const Raster::Pixel p = raster.at(static_cast<int>(kWidth / 2 + dx * radius),
                                          static_cast<int>(kHeight / 2 + dy * radius));
        return p.r + p.g + p.b;
      };
      EXPECT_GT(brightness(0, -0.6), brightness(0, 0.6));
      EXPECT_GT(brightness(0, 0), brightness(0.95, 0));
    }
  }
}

TEST_F(Pictures, ShowWhatIsNearerAndTheSameAgain) {
  Renderer renderer;
  const Viewpoint from = viewpoint();
  const DrawnPart near_one = part(ball(middle, 24)),
                  behind = part(ball(middle + 1.5 * (from.target - from.eye), 24), {0.1, 0.1, 0.9});
  const Raster alone = draw(renderer, {near_one}, from, 200, 150);
  // The hidden part is drawn first or last.
  for (const std::vector<DrawnPart>& parts : {std::vector{behind, near_one}, std::vector{near_one, behind}}) {
    const Raster shown = draw(renderer, parts, from, 200, 150), again = draw(renderer, parts, from, 200, 150);
    for (int y = 0; y < 150; ++y) {
      for (int x = 0; x < 200; ++x) {
        ASSERT_EQ(shown.at(x, y), again.at(x, y));
        const Raster::Pixel a = alone.at(x, y), b = shown.at(x, y);
        ASSERT_LE(std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}), 3);
      }
    }
  }
}

TEST_F(Pictures, TransparentPartsMixFromFarToNear) {
  Renderer renderer;
  const Viewpoint from = viewpoint();
  // Flat colours do not depend on the light.
  DrawnPart inner = part(ball(middle, 24), {1, 0, 0}), outer = part(ball(middle, 24), {0, 0, 1});
  for (DrawnPart* each : {&inner, &outer}) each->style.is_flat = true;
  TriangleSurface large = ball({0, 0, 0}, 24);
  for (Vec3& p : large.points) p = middle + 1.4 * p;
  outer.mesh = drawn_mesh(large);
  outer.style.opacity = 0.5;
  const auto middle_of = [&](const std::vector<DrawnPart>& parts) {
    return draw(renderer, parts, from, 100, 100).at(50, 50);
  };
  // The pixel is half the near side of the outer ball and half the inner ball behind it.
  const Raster::Pixel upon = middle_of({inner, outer});
  EXPECT_NEAR(upon.r, 128, 2);
  EXPECT_NEAR(upon.b, 128, 2);
  EXPECT_NEAR(upon.g, 0, 2);
  // Alone the outer ball is seen twice: its far side over white, and its near side over that.
  const Raster::Pixel twice = middle_of({outer});
  EXPECT_NEAR(twice.r, 64, 2);
  EXPECT_NEAR(twice.b, 255, 2);
  // Where both balls are transparent the order is near outer, near inner, far inner and far outer side, then
  // white.
  inner.style.opacity = 0.5;
  const Raster::Pixel all = middle_of({outer, inner});
  EXPECT_EQ(all, middle_of({inner, outer}));
  EXPECT_NEAR(all.r, 255 * (0.25 + 0.125 + 0.0625), 3);
  EXPECT_NEAR(all.b, 255 * (0.5 + 0.0625 + 0.0625), 3);
}

TEST_F(Pictures, PlanesCutAwayWhatIsInFrontOfThem) {
  Renderer renderer;
  const Viewpoint from = viewpoint();
  DrawnPart cut = part(ball(middle, 24), {0, 1, 0});
  cut.style.is_flat = true;
  cut.style.is_clipped = true;
  cut.style.back = {1, 0, 0};
  const Plane plane{middle, from.eye - from.target};
  const Raster::Pixel inside = draw(renderer, {cut}, from, 100, 100, Shading::kLit, plane).at(50, 50);
  EXPECT_EQ(inside.r, 255) << "the back side of the half that is left";
  EXPECT_EQ(inside.g, 0);
  cut.style.is_clipped = false;
  EXPECT_EQ(draw(renderer, {cut}, from, 100, 100, Shading::kLit, plane).at(50, 50).g, 255);
}

TEST_F(Pictures, ColoursShowValuesOfTheSideThatIsSeen) {
  Renderer renderer;
  const Viewpoint from = viewpoint();
  DrawnPart shown = part(ball(middle, 24), {0, 1, 0});
  shown.style.is_flat = true;
  shown.style.is_coloured_by_value = true;
  shown.style.low = 10;
  shown.style.high = 20;
  const auto with_values = [&](float front, float back) {
    DrawnMesh mesh = *drawn_mesh(ball(middle, 24));
    for (DrawnMesh::Vertex& vertex : mesh.vertices) {
      vertex.front_value = front;
      vertex.back_value = back;
    }
    shown.mesh = std::make_shared<const DrawnMesh>(std::move(mesh));
    return draw(renderer, {shown}, from, 100, 100).at(50, 50);
  };
  const ColourMap map = ColourMap::sequential();
  for (const float value : {10.0F, 14.0F, 20.0F, 90.0F}) {
    const auto [r, g, b] = to_bytes(map.at((value - 10) / 10.0));
    const Raster::Pixel pixel = with_values(value, 3);
    EXPECT_NEAR(pixel.r, r, 2);
    EXPECT_NEAR(pixel.g, g, 2);
    EXPECT_NEAR(pixel.b, b, 2);
  }
  EXPECT_EQ(with_values(std::nanf(""), 12).g, 255) << "its own colour where there is no value";
}

TEST_F(Pictures, DepthsAreDistancesAlongTheLineOfSight) {
  Renderer renderer;
  for (const double height : {0.0, 4.0}) {
    Viewpoint from = viewpoint();
    from.height = height;
    from.width_pixels = 101;
    from.height_pixels = 75;
    PictureContents contents;
    contents.viewpoint = from;
    contents.parts = {part(ball(middle, 100))};
    const PictureTarget target(101, 75);
    const DrawFigures figures = renderer.draw(contents, target.framebuffer(), 101, 75);
    const std::vector<float> depths = target.depths(from, figures.far);
    ASSERT_EQ(depths.size(), 101u * 75u);
    EXPECT_NEAR(depths[37 * 101 + 50], distance(from.eye, from.target) - 1, 0.01);
    EXPECT_TRUE(std::isinf(depths[0]));
    EXPECT_EQ(contents.parts.size(), 1u);
  }
}

TEST_F(Pictures, MeshesComeAndGoAndAreNotCopiedTwice) {
  Renderer renderer;
  const PictureTarget target(60, 60);
  PictureContents contents;
  contents.viewpoint = viewpoint();
  const auto drawn = [&] { return renderer.draw(contents, target.framebuffer(), 60, 60); };
  std::vector<DrawnPart> kept{part(ball(middle, 6))};
  contents.parts = kept;
  EXPECT_GT(drawn().copied_bytes, 0u);
  const Raster first = target.read();
  EXPECT_EQ(drawn().copied_bytes, 0u);
  // Together the meshes of these pictures need more memory than a block has.
  for (int n = 0; n < 12; ++n) {
    contents.parts = kept;
    contents.parts.push_back(part(ball(middle + Vec3{0.1 * n, 0, 0}, 150)));
    const DrawFigures figures = drawn();
    EXPECT_GT(figures.copied_bytes, 0u);
    EXPECT_EQ(figures.triangles,
              kept[0].mesh->indices.size() / 3 + contents.parts[1].mesh->indices.size() / 3);
  }
  contents.parts = kept;
  EXPECT_EQ(drawn().copied_bytes, 0u);
  const Raster last = target.read();
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) ASSERT_EQ(first.at(x, y), last.at(x, y));
  }
}

TEST_F(Pictures, ShowNothingOfNothing) {
  Renderer renderer;
  EXPECT_TRUE(is_background(draw(renderer, {}, viewpoint(), 40, 30).at(20, 15)));
  EXPECT_TRUE(is_background(draw(renderer, {part({})}, viewpoint(), 40, 30).at(20, 15)));
  EXPECT_THROW(PictureTarget(0, 30), Error);
  EXPECT_THROW(PictureTarget(1'000'000, 30), Error);
}

TEST_F(Pictures, ContextsSayWhatTheyAre) { EXPECT_NE(context->name().find("EGL"), std::string::npos); }

}  // namespace
}  // namespace adamas
