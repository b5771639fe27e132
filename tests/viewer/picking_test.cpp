#include "viewer/session/picking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "viewer/contents/surface_worker.h"

namespace adamas {

using namespace isosurface;
using namespace picture;
using namespace viewer;

namespace {

Viewpoint viewpoint(double height) {
  Viewpoint result;
  result.eye = {3, -8, 5};
  result.target = {0.5, 0.5, 0.5};
  result.up = {0, 0, 1};
  result.near = 0.1;
  result.height = height;
  result.width_pixels = 320;
  result.height_pixels = 200;
  return result;
}

TEST(Picking, RaysGoThroughWhatThePictureShowsThere) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (const double height : {0.0, 5.0}) {
    for (int n = 0; n < 100; ++n) {
      const Vec3 place{any(random), any(random), any(random)};
      const auto at = in_picture(viewpoint(height), place);
      ASSERT_TRUE(at);
      const Ray ray = ray_through(viewpoint(height), (*at)[0], (*at)[1]);
      const Vec3 way = place - ray.origin;
      EXPECT_LT(norm(cross(way, ray.direction)), 1e-9);
      EXPECT_NEAR(norm(ray.direction), 1, 1e-12);
    }
    EXPECT_FALSE(in_picture(viewpoint(height), viewpoint(height).eye));
  }
}

/// Returns triangles anywhere in the unit cube.
std::vector<DrawnPart> soup(std::mt19937& random) {
  std::uniform_real_distribution<double> any(0, 1);
  std::vector<DrawnPart> parts;
  for (int p = 0; p < 3; ++p) {
    TriangleSurface surface;
    for (std::uint32_t t = 0; t < 30; ++t) {
      for (int c = 0; c < 3; ++c) {
        surface.points.push_back({any(random), any(random), any(random)});
        surface.values.push_back(static_cast<float>(any(random)));
      }
      surface.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    parts.push_back({drawn_mesh(surface), {}});
    parts.back().style.is_clipped = p == 1;
  }
  return parts;
}

/// Returns the nearest hit, by intersection with the triangles' planes and a test against their edges.
std::optional<Hit> nearest_of(const std::vector<DrawnPart>& parts, const Ray& ray, const Plane& clip) {
  std::optional<Hit> nearest;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const DrawnMesh& mesh = *parts[p].mesh;
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
      std::array<Vec3, 3> c;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& place = mesh.vertices[mesh.indices[3 * t + k]].place;
        c[k] = mesh.origin + Vec3{place[0], place[1], place[2]};
      }
      const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
      const double along = dot(c[0] - ray.origin, normal) / dot(ray.direction, normal);
      const Vec3 at = ray.origin + along * ray.direction;
      bool is_inside = along > 0;
      for (std::size_t k = 0; k < 3; ++k)
        is_inside = is_inside && dot(cross(c[(k + 1) % 3] - c[k], at - c[k]), normal) >= 0;
      if (!is_inside || (nearest && along >= nearest->distance)) continue;
      if (parts[p].style.is_clipped && dot(at - clip.origin, clip.normal) > 0) continue;
      nearest = Hit{p, t, at, along, dot(ray.direction, normal) < 0, 0};
    }
  }
  return nearest;
}

TEST(Picking, FindsTheNearestTriangle) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> x(130, 190), y(70, 130);
  const Plane clip{{0.5, 0.5, 0.5}, {1, -2, 0.5}};
  int hits = 0;
  for (int n = 0; n < 40; ++n) {
    const std::vector<DrawnPart> parts = soup(random);
    for (int k = 0; k < 50; ++k) {
      const Ray ray = ray_through(viewpoint(n % 2 == 0 ? 0 : 3), x(random), y(random));
      const auto found = pick(parts, ray, clip), wanted = nearest_of(parts, ray, clip);
      ASSERT_EQ(found.has_value(), wanted.has_value());
      if (!found) continue;
      ++hits;
      EXPECT_EQ(found->part, wanted->part);
      EXPECT_EQ(found->triangle, wanted->triangle);
      EXPECT_EQ(found->is_front, wanted->is_front);
      EXPECT_LT(distance(found->place, wanted->place), 1e-6);
      EXPECT_GE(found->value, 0);
      EXPECT_LE(found->value, 1);
    }
  }
  EXPECT_GT(hits, 200);
}

}  // namespace
}  // namespace adamas
