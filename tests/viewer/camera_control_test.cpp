#include "viewer/session/camera_control.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "viewer/session/picking.h"

namespace adamas {

using namespace isosurface;
using namespace picture;
using namespace viewer;

namespace {

const Box3 kBox{{-1, 0, 2}, {3, 4, 10}};

Viewpoint viewpoint(bool is_parallel = false) {
  Viewpoint result;
  result.eye = {7, -9, 12};
  result.target = {1, 2, 3};
  result.up = {0, 0, 1};
  result.near = 0.01;
  result.width_pixels = 800;
  result.height_pixels = 600;
  return with_projection(result, is_parallel);
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-9) {
  EXPECT_LT(distance(a, b), tolerance)
      << a.x << ' ' << a.y << ' ' << a.z << " and " << b.x << ' ' << b.y << ' ' << b.z;
}

TEST(CameraControl, TurningKeepsTheDistanceAndTheTargetInTheMiddle) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> way(-300, 300);
  for (const CameraMode mode : {CameraMode::kTrackball, CameraMode::kTurntable, CameraMode::kFly}) {
    Viewpoint now = viewpoint();
    for (int n = 0; n < 200; ++n) {
      const Viewpoint next = rotated(now, mode, way(random), way(random));
      EXPECT_NEAR(distance(next.eye, next.target), distance(now.eye, now.target), 1e-9);
      expect_near(mode == CameraMode::kFly ? next.eye : next.target,
                  mode == CameraMode::kFly ? now.eye : now.target);
      if (mode != CameraMode::kTrackball) {
        expect_near(next.up, {0, 0, 1});
      }
      const View valid(next);
      now = next;
    }
  }
}

TEST(CameraControl, TheMouseTakesTheNearSideOfTheDataAlong) {
  for (const CameraMode mode : {CameraMode::kTrackball, CameraMode::kTurntable}) {
    const Viewpoint now = viewpoint();
    const Vec3 near_side = now.target + 0.3 * (now.eye - now.target);
    const auto before = in_picture(now, near_side);
    const auto right = in_picture(rotated(now, mode, 20, 0), near_side);
    EXPECT_GT((*right)[0], (*before)[0] + 5);
    const auto down = in_picture(rotated(now, mode, 0, 20), near_side);
    EXPECT_GT((*down)[1], (*before)[1] + 5);
  }
  // When the camera turns, what is ahead moves the other way.
  const auto ahead = in_picture(rotated(viewpoint(), CameraMode::kFly, 20, 0), viewpoint().target);
  EXPECT_LT((*ahead)[0], 395);
}

TEST(CameraControl, AFullTurnComesBack) {
  const Viewpoint now = viewpoint();
  for (const CameraMode mode : {CameraMode::kTrackball, CameraMode::kTurntable, CameraMode::kFly}) {
    const Viewpoint turned = rotated(now, mode, 2 * now.height_pixels, 0);
    expect_near(turned.eye, now.eye);
    expect_near(turned.target, now.target);
  }
}

TEST(CameraControl, PanningTakesTheTargetAlong) {
  for (const bool is_parallel : {false, true}) {
    const Viewpoint now = viewpoint(is_parallel), moved = panned(now, 37, -21);
    const auto at = in_picture(moved, now.target);
    EXPECT_NEAR((*at)[0], 400 + 37, 1e-6);
    EXPECT_NEAR((*at)[1], 300 - 21, 1e-6);
  }
}

TEST(CameraControl, StepsOfTheWheelMultiply) {
  for (const bool is_parallel : {false, true}) {
    const Viewpoint now = viewpoint(is_parallel);
    const Viewpoint there = zoomed(zoomed(now, 3), -3), nearer = zoomed(now, 1);
    expect_near(there.eye, now.eye);
    EXPECT_NEAR(there.height, now.height, 1e-12);
    const double size = is_parallel ? now.height / nearer.height
                                    : distance(now.eye, now.target) / distance(nearer.eye, nearer.target);
    EXPECT_NEAR(size, 1 / 0.9, 1e-12);
  }
}

TEST(CameraControl, AllIsShownFromEverywhere) {
  std::mt19937 random(5);
  std::normal_distribution<double> any;
  for (int n = 0; n < 200; ++n) {
    Viewpoint from = viewpoint(n % 2 == 0);
    from.width_pixels = n % 3 == 0 ? 300 : 900;
    from = showing_all(
        looking(from, {any(random), any(random), any(random)}, {any(random), any(random), any(random)}),
        kBox);
    const View view(from);
    for (const Vec3& corner : kBox.corners()) {
      EXPECT_TRUE(view.is_visible({corner, {}})) << n;
    }
    // The box is not much smaller than it could be: the ball round it fills the picture.
    const auto edge = in_picture(
        from, kBox.center() + 0.5 * kBox.diagonal() * normalized(cross(from.target - from.eye, from.up)));
    const double part = std::abs((*edge)[0] - from.width_pixels / 2.0) /
                        (0.5 * std::min(from.width_pixels, from.height_pixels));
    EXPECT_GT(part, 0.85);
  }
}

TEST(CameraControl, ProjectionsChangeNothingAtTheTarget) {
  const Viewpoint now = viewpoint();
  const Viewpoint parallel = with_projection(now, true), back = with_projection(parallel, false);
  expect_near(back.eye, now.eye);
  const Vec3 right = normalized(cross(now.target - now.eye, now.up));
  const auto a = in_picture(now, now.target + right), b = in_picture(parallel, now.target + right);
  EXPECT_NEAR((*a)[0], (*b)[0], 1e-9);
  EXPECT_EQ(with_projection(now, false), now);
}

TEST(CameraControl, WaysBetweenViewpointsBeginAndEndThere) {
  std::mt19937 random(9);
  std::normal_distribution<double> any;
  for (int n = 0; n < 100; ++n) {
    Viewpoint from = viewpoint(), to = viewpoint();
    to.eye = {10 * any(random), 10 * any(random), 10 * any(random)};
    to.up = {any(random), any(random), any(random)};
    // One of the cameras looks from the opposite side.
    if (n == 0) to.eye = to.target - (from.eye - from.target);
    EXPECT_EQ(between(from, to, 0), from);
    EXPECT_EQ(between(from, to, 1), to);
    for (const double t : {0.1, 0.5, 0.9}) {
      const Viewpoint there = between(from, to, t);
      const View valid(there);
      const double d = distance(there.eye, there.target), d0 = distance(from.eye, from.target),
                   d1 = distance(to.eye, to.target);
      EXPECT_GE(d, std::min(d0, d1) - 1e-9);
      EXPECT_LE(d, std::max(d0, d1) + 1e-9);
    }
  }
}

TEST(CameraControl, GoesAlongViewpointsFromTheFirstToTheLast) {
  std::vector<Viewpoint> path(4);
  for (std::size_t n = 0; n < path.size(); ++n) {
    path[n].eye = {static_cast<double>(n), -10, 2};
    path[n].target = {static_cast<double>(n), 0, 0};
    path[n].up = {0, 0, 1};
  }
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_EQ(along(path, n, 4), path[n]);
    EXPECT_EQ(along({path[2]}, n, 4), path[2]);
  }
  EXPECT_EQ(along(path, 0, 1), path[0]);
  EXPECT_EQ(along(path, 0, 2), path[0]);
  EXPECT_EQ(along(path, 1, 2), path[3]);
  for (std::size_t n = 0; n < 31; ++n)
    EXPECT_NEAR(along(path, n, 31).eye.x, 0.1 * static_cast<double>(n), 1e-9);
  EXPECT_EQ(along(path, 20, 31), path[2]) << "it goes through all of them";
}

}  // namespace
}  // namespace adamas
