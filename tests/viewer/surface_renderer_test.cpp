#include "viewer/gl/surface_renderer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/base/error.h"
#include "viewer/gl/offscreen_context.h"

namespace adamas {
namespace {

/// A ball of radius 1 about a point, with its normals.
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

class Renderer : public testing::Test {
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

  std::optional<OffscreenContext> context;
  const Vec3 middle{1000, -2000, 500};  ///< far off, where single precision has few digits left
};

TEST_F(Renderer, ShowsABallWhereItIs) {
  constexpr int kWidth = 320, kHeight = 240;
  SurfaceRenderer renderer(kWidth, kHeight);
  renderer.set_surface(ball(middle));
  for (const double height : {0.0, 4.0}) {
    Viewpoint from = viewpoint();
    from.height = height;
    const double distance = norm(Vec3{3, -4, 2});
    // The radius of its outline, in pixels.
    const double radius =
        height > 0 ? kHeight / height
                   : kHeight / (2 * std::tan(from.field_of_view / 2)) / std::sqrt(distance * distance - 1);
    for (const Shading shading : {Shading::kLit, Shading::kSphere}) {
      const Raster raster = renderer.draw(from, shading);
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
      // The light is above and to the left, and silhouettes are dark.
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

TEST_F(Renderer, ShowsWhatIsNearerAndTheSamePictureAgain) {
  SurfaceRenderer renderer(200, 150);
  TriangleSurface both = ball(middle, 24);
  const Viewpoint from = viewpoint();
  renderer.set_surface(both);
  const Raster near_one = renderer.draw(from, Shading::kLit);
  // One behind it and hidden by it, which comes later.
  const TriangleSurface behind = ball(middle + 1.5 * (from.target - from.eye), 24);
  const auto first = static_cast<std::uint32_t>(both.points.size());
  both.points.insert(both.points.end(), behind.points.begin(), behind.points.end());
  both.normals.insert(both.normals.end(), behind.normals.begin(), behind.normals.end());
  for (const auto& [a, b, c] : behind.triangles) both.triangles.push_back({a + first, b + first, c + first});
  renderer.set_surface(both);
  const Raster shown = renderer.draw(from, Shading::kLit), again = renderer.draw(from, Shading::kLit);
  for (int y = 0; y < 150; ++y) {
    for (int x = 0; x < 200; ++x) {
      ASSERT_EQ(shown.at(x, y), again.at(x, y));
      const Raster::Pixel a = near_one.at(x, y), b = shown.at(x, y);
      ASSERT_LE(std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}), 3);
    }
  }
}

TEST_F(Renderer, ShowsNothingOfNothing) {
  SurfaceRenderer renderer(40, 30);
  renderer.set_surface({});
  const Raster raster = renderer.draw(viewpoint(), Shading::kLit);
  EXPECT_TRUE(is_background(raster.at(20, 15)));
  EXPECT_THROW(SurfaceRenderer(0, 30), Error);
  EXPECT_THROW(SurfaceRenderer(1'000'000, 30), Error);
}

TEST_F(Renderer, ContextsSayWhatTheyAre) { EXPECT_NE(context->name().find("EGL"), std::string::npos); }

}  // namespace
}  // namespace adamas
