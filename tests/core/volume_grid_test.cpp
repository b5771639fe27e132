#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/data/anatomical_space.h"
#include "core/data/volume_placement.h"

namespace adamas {
namespace {

/// Grids with random directions: orthogonal or not, of either handedness, or along the axes.
class VolumeGrids : public testing::Test {
 protected:
  double number(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  Vec3 vector() { return {number(-1, 1), number(-1, 1), number(-1, 1)}; }

  VolumeGrid grid(bool orthogonal) {
    VolumeGrid grid;
    grid.dimensions = {7, 5, 9};
    grid.spacing = {number(0.1, 3), number(0.1, 3), number(0.1, 3)};
    grid.origin = 50 * vector();
    for (;;) {
      for (Vec3& d : grid.directions) d = normalized(vector());
      auto& [a, b, c] = grid.directions;
      if (std::abs(dot(cross(a, b), c)) < 0.2) continue;
      if (!orthogonal) return grid;
      b = normalized(b - dot(a, b) * a);
      c = number(-1, 1) < 0 ? -cross(a, b) : cross(a, b);
      return grid;
    }
  }
  Vec3 point(const Box3& box) {
    return {number(box.min.x, box.max.x), number(box.min.y, box.max.y), number(box.min.z, box.max.z)};
  }

  std::mt19937 random_{5};
};

TEST_F(VolumeGrids, ThereAndBack) {
  for (int n = 0; n < 200; ++n) {
    const VolumeGrid g = grid(n % 2 == 0);
    g.check("grid");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Vec3 step = g.origin;
      step[static_cast<int>(axis)] += g.spacing[static_cast<int>(axis)];
      const Vec3 way = g.spacing[static_cast<int>(axis)] * g.directions[axis];
      EXPECT_LT(distance(g.in_space(step), g.origin + way), 1e-12);
    }
    const Vec3 p = point(g.frame_box());
    EXPECT_LT(distance(g.in_frame(g.in_space(p)), p), 1e-11);
    const Box3 box = g.box();
    const Vec3 q = g.in_space(p);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(q[axis], box.min[axis] - 1e-12);
      EXPECT_LE(q[axis], box.max[axis] + 1e-12);
    }
  }
}

TEST_F(VolumeGrids, DistancesAreStretchedByNoMore) {
  for (int n = 0; n < 40; ++n) {
    const VolumeGrid g = grid(n % 4 == 0);
    double greatest = 0;
    for (int m = 0; m < 20000; ++m) {
      const Vec3 way = normalized(vector());
      greatest = std::max(greatest, distance(g.in_space(g.origin + way), g.origin));
    }
    EXPECT_LE(greatest, g.greatest_stretch() + 1e-9);
    EXPECT_GE(greatest, 0.999 * g.greatest_stretch());
    if (n % 4 == 0) {
      EXPECT_NEAR(g.greatest_stretch(), 1, 1e-12);
    }
  }
}

TEST_F(VolumeGrids, AxesThatAreHardlyAslantStretchNothing) {
  for (const double aslant : {1e-20, 1e-120, 1e-200, 1e-310}) {
    VolumeGrid g = grid(true);
    g.directions = {{{1, aslant, 0}, {0, 1, 0}, {0, 0, 1}}};
    EXPECT_NEAR(g.greatest_stretch(), 1, 1e-12) << aslant;
  }
}

TEST_F(VolumeGrids, RegionsAreTheSameInTheFrame) {
  for (int n = 0; n < 50; ++n) {
    const VolumeGrid g = grid(n % 2 == 0);
    const Box3 all = g.box();
    Box3 box;
    box.extend(point(all));
    box.extend(point(all));
    const FrameRegion region = region_in_frame(g, box);
    std::size_t inside = 0;
    for (int m = 0; m < 2000; ++m) {
      const Vec3 p = point(all), in_frame = g.in_frame(p);
      bool found = region.box.contains(in_frame);
      for (const Plane& side : region.sides) found = found && dot(side.normal, in_frame - side.origin) <= 0;
      EXPECT_EQ(found, box.contains(p));
      inside += found ? 1 : 0;
    }
    EXPECT_LT(inside, 2000u);
  }
  VolumeGrid exchanged;
  exchanged.dimensions = {7, 5, 9};
  exchanged.origin = {1, 2, 3};
  exchanged.directions = {{{0, -1, 0}, {0, 0, 1}, {1, 0, 0}}};
  const FrameRegion region = region_in_frame(exchanged, {{1, -4, 3}, {2, 1, 7}});
  EXPECT_TRUE(region.sides.empty());
  EXPECT_EQ(region.box.min, (Vec3{2, 2, 3}));
  EXPECT_EQ(region.box.max, (Vec3{7, 6, 4}));
}

TEST_F(VolumeGrids, SurfacesKeepTheirOutside) {
  for (int n = 0; n < 50; ++n) {
    const VolumeGrid g = grid(n % 2 == 0);
    // This is a tetrahedron whose triangles face outwards. The normals at its corners are those of the planes
    // x = 0, y = 0 and z = 0.
    TriangleSurface surface;
    surface.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    surface.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    surface.normals = {normalized(Vec3{-1, -1, -1}), {0, 0, -1}, {-1, 0, 0}, {0, -1, 0}};
    const double before = 1.0 / 6;
    place_in_space(g, surface);
    double volume = 0;
    for (const auto& [a, b, c] : surface.triangles)
      volume += signed_volume(g.origin, surface.points[a], surface.points[b], surface.points[c]);
    const auto& [i, j, k] = g.directions;
    EXPECT_NEAR(volume, before * std::abs(dot(cross(i, j), k)), 1e-9);
    // The normal of z = 0 is perpendicular to x and y in space and leads away from the rest.
    EXPECT_NEAR(norm(surface.normals[1]), 1, 1e-12);
    EXPECT_NEAR(dot(surface.normals[1], i), 0, 1e-12);
    EXPECT_NEAR(dot(surface.normals[1], j), 0, 1e-12);
    EXPECT_LT(dot(surface.normals[1], k), 0);
    const Plane plane = plane_in_frame(g, {g.in_space({1, 2, 3}), g.directions[0]});
    EXPECT_NEAR(dot(plane.normal, Vec3{1, 2, 3} - plane.origin), 0, 1e-9);
  }
}

TEST_F(VolumeGrids, BadOnesAreNamed) {
  VolumeGrid g = grid(true);
  g.directions[1] *= 1.001;
  EXPECT_ANY_THROW(g.check("x"));
  g.directions[1] = g.directions[0];
  EXPECT_ANY_THROW(g.check("x"));
  g.directions[1].x = std::nan("");
  EXPECT_ANY_THROW(g.check("x"));
}

TEST_F(VolumeGrids, SpacesByAnyName) {
  for (const char* name : {"RAS", "ras", "RAST", "right-anterior-superior", "Right-Anterior-Superior-Time"})
    EXPECT_EQ(space_of_nrrd(name), "RAS") << name;
  EXPECT_EQ(space_of_nrrd("LPS"), "LPS");
  EXPECT_EQ(space_of_nrrd("left-anterior-superior"), "LAS");
  EXPECT_EQ(space_of_nrrd("3d-left-handed-time"), "3D-left-handed");
  EXPECT_EQ(space_of_nrrd("scanner-xyz"), "scanner-xyz");
  EXPECT_EQ(space_of_nrrd("moon"), "");
  EXPECT_EQ(space_of_nrrd(""), "");
  for (const char* name : {"RAS", "LAS", "LPS", "scanner-xyz", "3D-right-handed", "3D-left-handed"}) {
    EXPECT_TRUE(is_space(name));
    EXPECT_EQ(space_of_nrrd(nrrd_space(name)), name);
  }
  EXPECT_EQ(nrrd_space(""), "");
  // Places stay the same; only their coordinates change.
  VolumeGrid g = grid(false);
  g.space = "RAS";
  const Vec3 before = g.in_space(g.frame_box().max);
  ASSERT_TRUE(to_space("LPS", g));
  const auto last = [](const VolumeGrid& of) {
    Vec3 p = of.origin;
    for (std::size_t a = 0; a < 3; ++a)
      p += static_cast<double>(of.dimensions[a] - 1) * of.spacing[static_cast<int>(a)] * of.directions[a];
    return p;
  };
  EXPECT_LT(distance(last(g), {-before.x, -before.y, before.z}), 1e-11);
  ASSERT_TRUE(to_space("LAS", g));
  EXPECT_LT(distance(last(g), {-before.x, before.y, before.z}), 1e-11);
  g.space = "scanner-xyz";
  EXPECT_FALSE(to_space("LPS", g));
}

}  // namespace
}  // namespace adamas
