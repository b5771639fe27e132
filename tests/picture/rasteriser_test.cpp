#include "core/picture/rasteriser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "core/base/error.h"

namespace adamas {

using namespace picture;

namespace {

constexpr int kWidth = 96, kHeight = 64;
const Box3 kBox{{-1, -2, 0}, {3, 1, 2}};

std::vector<PictureTriangle> random_triangles(std::mt19937_64& random, int count, const Box3& box) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto point = [&] {
    const Vec3 s = box.size();
    return box.min + Vec3{s.x * unit(random), s.y * unit(random), s.z * unit(random)};
  };
  std::vector<PictureTriangle> triangles;
  for (int i = 0; i < count; ++i)
    triangles.push_back({{point(), point(), point()}, {unit(random), 0.5, 0.5}});
  return triangles;
}

struct Ray {
  Vec3 origin, direction;
};

// Returns the distance along the ray to a triangle (Moeller and Trumbore), infinite where it misses. `margin`
// becomes the least barycentric weight of the hit, which says how far inside it lies.
double hit(const Ray& ray, const PictureTriangle& t, double& margin) {
  const Vec3 e1 = t.points[1] - t.points[0], e2 = t.points[2] - t.points[0];
  const Vec3 p = cross(ray.direction, e2);
  const double determinant = dot(e1, p);
  const Vec3 s = ray.origin - t.points[0], q = cross(s, e1);
  const double u = dot(s, p) / determinant, v = dot(ray.direction, q) / determinant;
  margin = std::min({u, v, 1 - u - v});
  return margin >= 0 ? dot(e2, q) / determinant : std::numeric_limits<double>::infinity();
}

// Returns the ray of the centre of a pixel. It is found by projections alone: two points in space are sought
// that are drawn there.
Ray ray_through(const Camera& camera, const Box3& box, double px, double py) {
  // The projection is affine on each of two planes across the view, so three of its points determine the one
  // that is sought.
  const auto on_plane = [&](double distance) {
    const Vec3 centre = box.center() + distance * camera.forward();
    const Vec2 o = camera.project(centre).at, r = camera.project(centre + camera.right()).at,
               u = camera.project(centre + camera.up()).at;
    const Vec2 d{px - o.x, py - o.y};
    const double area = cross(r - o, u - o);
    return centre + (cross(d, u - o) / area) * camera.right() + (cross(r - o, d) / area) * camera.up();
  };
  const Vec3 near = on_plane(-0.5 * box.diagonal()), far = on_plane(box.diagonal());
  return {near, far - near};
}

TEST(Rasteriser, ShowsWhatRaysHitFirst) {
  std::mt19937_64 random(11);
  for (const Projection projection : {Projection::kOrthographic, Projection::kPerspective}) {
    for (int round = 0; round < 12; ++round) {
      std::uniform_real_distribution<double> unit(-1, 1);
      const Vec3 direction{unit(random), unit(random), unit(random)};
      const Camera camera(projection, kBox, direction, kWidth, kHeight);
      const std::vector<PictureTriangle> triangles = random_triangles(random, 1 + 4 * round, kBox);
      Rasteriser rasteriser(camera, kWidth, kHeight);
      rasteriser.draw(triangles);
      int compared = 0;
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const Ray ray = ray_through(camera, kBox, x + 0.5, y + 0.5);
          std::uint32_t first = Rasteriser::kNone;
          double best = std::numeric_limits<double>::infinity(), second = best, closest_margin = 1;
          for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            double margin = 0;
            const double t = hit(ray, triangles[i], margin);
            closest_margin = std::min(closest_margin, std::abs(margin));
            if (t < best)
              second = best, best = t, first = i;
            else
              second = std::min(second, t);
          }
          if (closest_margin < 1e-9 || second - best < 1e-9) continue;  // too close to call
          ++compared;
          ASSERT_EQ(rasteriser.triangle_at(x, y), first) << x << " " << y << " round " << round;
        }
      }
      EXPECT_GT(compared, kWidth * kHeight * 9 / 10);
    }
  }
}

TEST(Rasteriser, DepthIsTheDistanceAlongTheView) {
  std::mt19937_64 random(12);
  for (const Projection projection : {Projection::kOrthographic, Projection::kPerspective}) {
    const Camera camera(projection, kBox, {1, 2, -1}, kWidth, kHeight);
    const std::vector<PictureTriangle> triangles = random_triangles(random, 6, kBox);
    Rasteriser rasteriser(camera, kWidth, kHeight);
    rasteriser.draw(triangles);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const std::uint32_t number = rasteriser.triangle_at(x, y);
        if (number == Rasteriser::kNone) continue;
        const Ray ray = ray_through(camera, kBox, x + 0.5, y + 0.5);
        double margin = 0;
        const double t = hit(ray, triangles[number], margin);
        if (margin < 1e-9) continue;
        const double distance = camera.distance_of(ray.origin + t * ray.direction);
        EXPECT_NEAR(camera.distance_at_depth(rasteriser.depth_at(x, y)), distance, 1e-8 * kBox.diagonal());
      }
    }
  }
}

TEST(Camera, FramesTheWholeBoxTightly) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const Projection projection : {Projection::kOrthographic, Projection::kPerspective}) {
    for (int round = 0; round < 200; ++round) {
      const Vec3 direction = round == 0 ? Vec3{0, 0, -1} : Vec3{unit(random), unit(random), unit(random)};
      const Camera camera(projection, kBox, direction, kWidth, kHeight, 0.1);
      Box2 extent;
      for (unsigned i = 0; i < 8; ++i) {
        const Vec3 p{(i & 1u) != 0 ? kBox.max.x : kBox.min.x, (i & 2u) != 0 ? kBox.max.y : kBox.min.y,
                     (i & 4u) != 0 ? kBox.max.z : kBox.min.z};
        ASSERT_GE(camera.distance_of(p), camera.near());
        extent.extend(camera.project(p).at);
      }
      const double left = 0.05 * kWidth, top = 0.05 * kHeight, tolerance = 1e-9 * kWidth;
      EXPECT_GE(extent.min.x, left - tolerance);
      EXPECT_GE(extent.min.y, top - tolerance);
      EXPECT_LE(extent.max.x, kWidth - left + tolerance);
      EXPECT_LE(extent.max.y, kHeight - top + tolerance);
      const double slack = std::min({extent.min.x - left, extent.min.y - top, kWidth - left - extent.max.x,
                                     kHeight - top - extent.max.y});
      EXPECT_LT(slack, 1e-6);
    }
  }
}

TEST(Camera, UpIsUp) {
  const Camera camera(Projection::kPerspective, kBox, {1, 1, -0.5}, kWidth, kHeight);
  EXPECT_LT(camera.project({0, 0, 1.5}).at.y, camera.project({0, 0, 0.5}).at.y);
  EXPECT_THROW(Camera(Projection::kPerspective, kBox, {0, 0, 0}, 10, 10), Error);
  EXPECT_THROW(Camera(Projection::kPerspective, Box3{}, {0, 0, 1}, 10, 10), Error);
}

TEST(Rasteriser, TrianglesBehindTheCameraAreCut) {
  const Camera camera(Projection::kPerspective, kBox, {0, 1, 0}, kWidth, kHeight);
  // The floor extends from far behind the camera to far in front of it, below the box. The camera sees it in
  // the lower half of the picture only.
  const std::vector<PictureTriangle> floor{
      {{Vec3{-1e3, -1e3, -0.5}, Vec3{1e3, -1e3, -0.5}, Vec3{1, 1e5, -0.5}}, {1, 0, 0}},
      {{Vec3{-1, -1e4, 0}, Vec3{1, -1e4, 0}, Vec3{0, -1e4, 1}}, {0, 1, 0}}};
  Rasteriser rasteriser(camera, kWidth, kHeight);
  rasteriser.draw(floor);
  for (int x = 0; x < kWidth; ++x) {
    EXPECT_EQ(rasteriser.triangle_at(x, 0), Rasteriser::kNone);
    EXPECT_EQ(rasteriser.triangle_at(x, kHeight - 1), 0u);
  }
}

TEST(Rasteriser, LinesAreHiddenBySurfaces) {
  const Camera camera(Projection::kOrthographic, kBox, {0, 1, 0}, kWidth, kHeight);
  const double y = -0.5;
  const std::vector<PictureTriangle> wall{{{Vec3{-9, y, -9}, Vec3{9, y, -9}, Vec3{0, y, 20}}, {0, 0, 1}}};
  Rasteriser rasteriser(camera, kWidth, kHeight);
  rasteriser.draw(wall);
  const Colour red{1, 0, 0};
  const auto red_pixels = [&](double at) {
    Raster raster = rasteriser.shade({.outlines = false});
    rasteriser.draw_line(raster, {-1, at, 1}, {3, at, 1}, 2, red);
    int count = 0;
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) count += raster.at(u, v) == Raster::Pixel{255, 0, 0, 255} ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(red_pixels(0.5), 0);
  EXPECT_GT(red_pixels(-1.5), kWidth);
}

TEST(Rasteriser, PointsMustBeFinite) {
  const Camera camera(Projection::kOrthographic, kBox, {0, 1, 0}, kWidth, kHeight);
  const std::vector<PictureTriangle> bad{{{Vec3{0, 0, 0}, Vec3{1, NAN, 0}, Vec3{1, 1, 1}}, {}}};
  Rasteriser rasteriser(camera, kWidth, kHeight);
  EXPECT_THROW(rasteriser.draw(bad), Error);
}

TEST(Rasteriser, EachSideHasItsColour) {
  const Colour front{0.9, 0.1, 0.1}, back{0.1, 0.1, 0.9};
  const std::array<Vec3, 3> points{Vec3{-1, -1, 0}, Vec3{1, -1, 0}, Vec3{0, 1, 0}};
  const Box3 box{{-1, -1, -1}, {1, 1, 1}};
  for (const Projection projection : {Projection::kOrthographic, Projection::kPerspective}) {
    for (const bool from_above : {true, false}) {
      // The normal is z, so the front is seen from above.
      const Camera camera(projection, box, {0.1, 0.2, from_above ? -1.0 : 1.0}, 40, 40);
      Rasteriser rasteriser(camera, 40, 40);
      const std::vector<PictureTriangle> triangles{{points, front, back}};
      rasteriser.draw(triangles);
      ASSERT_EQ(rasteriser.triangle_at(20, 20), 0u);
      EXPECT_EQ(rasteriser.facing_colour(0), from_above ? front : back);
      const Raster::Pixel pixel = rasteriser.shade({.outlines = false}).at(20, 20);
      EXPECT_EQ(pixel.r > pixel.b, from_above);
    }
  }
  // Where a triangle has one colour, both sides have it.
  Rasteriser rasteriser(Camera(Projection::kOrthographic, box, {0, 0, 1}, 40, 40), 40, 40);
  const std::vector<PictureTriangle> plain{{points, front}};
  rasteriser.draw(plain);
  EXPECT_EQ(rasteriser.facing_colour(0), front);
}

/// Triangles of a sphere about a point, divided by angles, with the normals at their corners.
struct Sphere {
  std::vector<PictureTriangle> triangles;
  std::vector<CornerNormals> normals;

  Sphere(const Vec3& centre, double radius, int parts) {
    const auto direction = [parts](int i, int j) {
      const double u = std::numbers::pi * i / parts,
                   v = 2 * std::numbers::pi * (j % (2 * parts)) / (2 * parts);
      return Vec3{std::sin(u) * std::cos(v), std::sin(u) * std::sin(v), std::cos(u)};
    };
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      if (norm(cross(b - a, c - a)) < 1e-9) return;
      triangles.push_back({{centre + radius * a, centre + radius * b, centre + radius * c}, {0.8, 0.7, 0.6}});
      normals.push_back({a, b, c});
    };
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; j < 2 * parts; ++j) {
        add(direction(i, j), direction(i + 1, j), direction(i + 1, j + 1));
        add(direction(i, j), direction(i + 1, j + 1), direction(i, j + 1));
      }
    }
  }
};

Raster shaded(const std::vector<PictureTriangle>& triangles, const std::vector<CornerNormals>& normals) {
  const Camera camera(Projection::kPerspective, kBox, {-0.62, 0.72, -0.42}, kWidth, kHeight);
  Rasteriser rasteriser(camera, kWidth, kHeight);
  rasteriser.draw(triangles, normals);
  return rasteriser.shade({.outlines = false});
}

bool same_pixels(const Raster& a, const Raster& b) {
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (!(a.at(x, y) == b.at(x, y))) return false;
    }
  }
  return true;
}

TEST(Rasteriser, NormalsOfTheTrianglesThemselvesChangeNothing) {
  std::mt19937_64 random(5);
  const std::vector<PictureTriangle> triangles = random_triangles(random, 40, kBox);
  std::vector<CornerNormals> normals;
  for (const PictureTriangle& t : triangles) {
    const Vec3 normal = normalized(cross(t.points[1] - t.points[0], t.points[2] - t.points[0]));
    normals.push_back({normal, normal, normal});
  }
  const Raster flat = shaded(triangles, {}), smooth = shaded(triangles, normals);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      ASSERT_EQ(flat.at(x, y).a, smooth.at(x, y).a);
      ASSERT_NEAR(flat.at(x, y).r, smooth.at(x, y).r, 1);
    }
  }
}

TEST(Rasteriser, NormalsMakeACoarseSphereLookLikeAFineOne) {
  const Sphere coarse(kBox.center(), 0.9, 8), fine(kBox.center(), 0.9, 200);
  const Raster truth = shaded(fine.triangles, {}), flat = shaded(coarse.triangles, {}),
               smooth = shaded(coarse.triangles, coarse.normals);
  const auto difference = [&truth](const Raster& raster) {
    double sum = 0, count = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (truth.at(x, y).a == 0 || raster.at(x, y).a == 0) continue;
        sum += std::abs(truth.at(x, y).r - raster.at(x, y).r);
        ++count;
      }
    }
    EXPECT_GT(count, 400);
    return sum / count;
  };
  EXPECT_LT(difference(smooth), 0.35 * difference(flat));
}

TEST(Rasteriser, TheOrderOfCornersDoesNotMatterToNormals) {
  const Sphere sphere(kBox.center(), 0.9, 8);
  std::vector<PictureTriangle> turned = sphere.triangles;
  std::vector<CornerNormals> normals = sphere.normals;
  for (PictureTriangle& t : turned) std::swap(t.points[1], t.points[2]);
  for (CornerNormals& n : normals) n = {-n[0], -n[2], -n[1]};
  const Raster one = shaded(sphere.triangles, sphere.normals), other = shaded(turned, normals);
  int differences = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) differences += std::abs(one.at(x, y).r - other.at(x, y).r) > 1 ? 1 : 0;
  }
  EXPECT_EQ(differences, 0);
  EXPECT_FALSE(same_pixels(one, shaded(sphere.triangles, {})));
}

}  // namespace
}  // namespace adamas
