#include "isosurface/view/depth_pyramid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace adamas {

using namespace isosurface;

namespace {

Viewpoint viewpoint(double height) {
  Viewpoint result;
  result.eye = {-3, 1, 2};
  result.target = {0.2, 0, 0.1};
  result.up = {0, 0.3, 1};
  result.near = 0.05;
  result.height = height;
  result.width_pixels = 150;
  result.height_pixels = 97;
  return result;
}

/// Returns the depths of a ball of radius 0.6 about the target, with nothing around it. The ray of each pixel
/// is intersected with the ball.
std::vector<float> depths_of_ball(const Viewpoint& v) {
  const Vec3 forward = normalized(v.target - v.eye), right = normalized(cross(forward, v.up)),
             up = cross(right, forward);
  std::vector<float> depths;
  for (int y = 0; y < v.height_pixels; ++y) {
    for (int x = 0; x < v.width_pixels; ++x) {
      const double half = v.height > 0 ? v.height / 2 : std::tan(v.field_of_view / 2);
      const double a = (x + 0.5 - v.width_pixels / 2.0) * 2 * half / v.height_pixels,
                   b = (v.height_pixels / 2.0 - y - 0.5) * 2 * half / v.height_pixels;
      const Vec3 origin = v.height > 0 ? v.eye + a * right + b * up : v.eye;
      const Vec3 way = v.height > 0 ? forward : forward + a * right + b * up;
      const Vec3 offset = origin - v.target;
      const double p = dot(way, offset) / dot(way, way), q = (dot(offset, offset) - 0.36) / dot(way, way);
      const double root = p * p - q;
      depths.push_back(root < 0 ? std::numeric_limits<float>::infinity()
                                : static_cast<float>(-p - std::sqrt(root)));
    }
  }
  return depths;
}

/// Returns whether a point lies in the ball, or the ball lies between the point and the eye.
bool is_behind_ball(const Viewpoint& v, const Vec3& p) {
  const Vec3 way = v.height > 0 ? normalized(v.eye - v.target) : normalized(v.eye - p);
  const double along = dot(v.target - p, way);
  return norm(v.target - p) < 0.6 || (along > 0 && norm(v.target - p - along * way) < 0.6);
}

std::array<Vec3, 8> corners_of(const CentredBox& box) {
  return Box3{box.centre - box.half, box.centre + box.half}.corners();
}

TEST(DepthPyramid, HidesWhatIsBehindABall) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto side = [&] { return 0.04 * std::abs(any(random)); };
  for (const double height : {0.0, 3.0}) {
    const Viewpoint v = viewpoint(height);
    // Depths are given at the centres of pixels, so nothing is known beyond the outermost centres.
    Viewpoint inner = v;
    inner.field_of_view = 2 * std::atan((1 - 2.0 / v.height_pixels) * std::tan(v.field_of_view / 2));
    inner.height = (1 - 2.0 / v.height_pixels) * v.height;
    const View view(inner);
    const DepthPyramid pyramid(v, depths_of_ball(v));
    int hidden = 0, missed = 0;
    for (int n = 0; n < 40'000; ++n) {
      const CentredBox box{{2 * any(random), 2 * any(random), 2 * any(random)}, {side(), side(), side()}};
      const auto corners = corners_of(box);
      const auto is_behind = [&](const Vec3& corner) { return is_behind_ball(v, corner); };
      if (!pyramid.hides(box)) {
        // The region behind a ball is convex, so a box lies in it where all its corners do.
        missed += std::ranges::all_of(corners, is_behind) ? 1 : 0;
        continue;
      }
      for (const Vec3& corner : corners) {
        if (!view.is_visible({corner, {}})) continue;
        EXPECT_TRUE(is_behind(corner));
        ++hidden;
      }
    }
    EXPECT_GT(hidden / 8, 200);
    EXPECT_LT(missed, hidden / 4) << "most of what is hidden is found";
  }
}

TEST(DepthPyramid, WhatLiesInAHiddenBoxIsHidden) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (const double height : {0.0, 3.0}) {
    const Viewpoint v = viewpoint(height);
    const DepthPyramid pyramid(v, depths_of_ball(v));
    int pairs = 0;
    for (int n = 0; n < 50'000; ++n) {
      const CentredBox outer{
          {2 * any(random), 2 * any(random), 2 * any(random)},
          {0.2 * std::abs(any(random)), 0.2 * std::abs(any(random)), 0.2 * std::abs(any(random))}};
      if (!pyramid.hides(outer)) continue;
      const double part = std::abs(any(random));
      const double room = 1 - part;
      const CentredBox inner{
          outer.centre + Vec3{room * outer.half.x * any(random), room * outer.half.y * any(random),
                              room * outer.half.z * any(random)},
          part * outer.half};
      EXPECT_TRUE(pyramid.hides(inner));
      ++pairs;
    }
    EXPECT_GT(pairs, 200);
  }
}

TEST(DepthPyramid, HidesNothingWithoutAnythingInFront) {
  const Viewpoint v = viewpoint(0);
  const std::vector<float> empty(150 * 97, std::numeric_limits<float>::infinity());
  EXPECT_FALSE(DepthPyramid(v, empty).hides({v.target, {0.01, 0.01, 0.01}}));
  const std::vector<float> wall(150 * 97, 1.0F);
  const DepthPyramid behind_wall(v, wall);
  EXPECT_TRUE(behind_wall.hides({v.target, {0.01, 0.01, 0.01}}));
  EXPECT_FALSE(behind_wall.hides({v.eye, {0.01, 0.01, 0.01}})) << "the near plane cuts it";
  EXPECT_FALSE(behind_wall.hides({v.eye - (v.target - v.eye), {0.01, 0.01, 0.01}})) << "behind the eye";
}

}  // namespace
}  // namespace adamas
