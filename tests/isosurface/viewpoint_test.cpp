#include "isosurface/view/viewpoint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/error.h"

namespace adamas {

using namespace isosurface;

namespace {

Viewpoint random_viewpoint(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-3, 3), angle(0.2, 2);
  Viewpoint viewpoint;
  const auto point = [&] { return Vec3{place(random), place(random), place(random)}; };
  viewpoint.eye = point();
  viewpoint.target = point();
  viewpoint.up = point();
  viewpoint.field_of_view = angle(random);
  viewpoint.height = random() % 3 == 0 ? 2 : 0;
  viewpoint.near = 0.05;
  viewpoint.width_pixels = 300 + static_cast<int>(random() % 600);
  return viewpoint;
}

/// The place of a point in the picture, in pixels from its middle, and its distance along the line of sight.
struct Place {
  double x, y, depth;
};
Place project(const Viewpoint& viewpoint, const Vec3& p) {
  const Vec3 forward = normalized(viewpoint.target - viewpoint.eye),
             right = normalized(cross(forward, viewpoint.up)), up = cross(right, forward);
  const Vec3 way = p - viewpoint.eye;
  const double depth = dot(way, forward);
  const double scale = viewpoint.height > 0
                           ? viewpoint.height_pixels / viewpoint.height
                           : viewpoint.height_pixels / (2 * std::tan(viewpoint.field_of_view / 2)) / depth;
  return {scale * dot(way, right), scale * dot(way, up), depth};
}

TEST(View, BoundsWhatTheCameraShows) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1, 1), place(-3, 3);
  std::size_t seen = 0;
  for (int n = 0; n < 20'000; ++n) {
    const Viewpoint viewpoint = random_viewpoint(random);
    const View view(viewpoint);
    const CentredBox box{{place(random), place(random), place(random)},
                         {std::abs(unit(random)), std::abs(unit(random)), std::abs(unit(random))}};
    const auto in_box = [&] {
      return box.centre +
             Vec3{unit(random) * box.half.x, unit(random) * box.half.y, unit(random) * box.half.z};
    };
    const Vec3 a = in_box(), b = in_box();
    const Place p = project(viewpoint, a), q = project(viewpoint, b);
    const bool in_picture = p.depth >= viewpoint.near && 2 * std::abs(p.x) <= viewpoint.width_pixels &&
                            2 * std::abs(p.y) <= viewpoint.height_pixels;
    if (!in_picture) continue;
    EXPECT_TRUE(view.is_visible(box));
    if (q.depth < p.depth) continue;
    ++seen;
    EXPECT_LE(std::hypot(p.x - q.x, p.y - q.y), (1 + 1e-12) * view.pixels(distance(a, b), box));
  }
  EXPECT_GT(seen, 500u);
}

TEST(View, IsMonotone) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1), place(-3, 3);
  for (int n = 0; n < 20'000; ++n) {
    const View view(random_viewpoint(random));
    const CentredBox outer{{place(random), place(random), place(random)}, {1.5, 1, 2}};
    const Vec3 half{1.5 * unit(random), unit(random), 2 * unit(random)}, room = outer.half - half;
    const auto way = [&](double r) { return (2 * unit(random) - 1) * r; };
    const CentredBox inner{outer.centre + Vec3{way(room.x), way(room.y), way(room.z)}, half};
    if (view.is_visible(inner)) {
      EXPECT_TRUE(view.is_visible(outer));
    }
    EXPECT_LE(view.pixels(1, inner), (1 + 1e-12) * view.pixels(1, outer));
  }
}

TEST(View, RefusesCamerasThatSeeNothing) {
  const auto refused = [](auto change) {
    Viewpoint viewpoint;
    change(viewpoint);
    EXPECT_THROW(View{viewpoint}, Error);
  };
  refused([](Viewpoint& c) { c.eye = c.target; });
  refused([](Viewpoint& c) { c.up = c.target - c.eye; });
  refused([](Viewpoint& c) { c.width_pixels = 0; });
  refused([](Viewpoint& c) { c.field_of_view = 4; });
  refused([](Viewpoint& c) { c.near = 0; });
  refused([](Viewpoint& c) { c.eye.x = NAN; });
}

}  // namespace
}  // namespace adamas
