#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "core/base/error.h"
#include "core/geometry/plane.h"
#include "core/geometry/plane_sides.h"
#include "tests/interfaces/cross_section_meshes.h"

namespace adamas {
namespace {

const Box3 kUnit{{0, 0, 0}, {1, 1, 1}};

std::string message(const std::function<void()>& what) {
  try {
    what();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(CrossSectionPlane, TextsThatNameOne) {
  EXPECT_EQ(parse_plane("x=6").origin, (Vec3{6, 0, 0}));
  EXPECT_EQ(parse_plane("x=6").normal, (Vec3{1, 0, 0}));
  EXPECT_EQ(parse_plane(" y = -1.5e3 ").origin, (Vec3{0, -1500, 0}));
  EXPECT_EQ(parse_plane("z=+.25").origin, (Vec3{0, 0, 0.25}));
  EXPECT_EQ(parse_plane("z=0").normal, (Vec3{0, 0, 1}));
}

TEST(CrossSectionPlane, TextsThatNameNone) {
  for (const char* text : {"", "x", "=", "x=", "=3", "w=1", "xy=1", "x=1,", "x=1 2", "x=nan", "x=inf",
                           "x=-inf", "x=1e999", "x==1", "x=++1", "x=+-1", "6", "x=0x"}) {
    const std::string found = message([&] { parse_plane(text); });
    EXPECT_NE(found.find("expected x=NUMBER"), std::string::npos) << text;
    EXPECT_NE(found.find("'" + std::string(text) + "'"), std::string::npos) << text;
    EXPECT_EQ(found.find('\n'), std::string::npos);
  }
}

TEST(CrossSectionPlane, PlanesThatCannotCutAreErrors) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const auto error_of = [](const Plane& plane) {
    return message([&] { PlaneSides(plane, kUnit, "box.vtu"); });
  };
  EXPECT_EQ(error_of({{0.5, 0, 0}, {1, 0, 0}}), "");
  EXPECT_EQ(error_of({{0.5, 7, -1e6}, {-1e-300, 0, 0}}), "");
  EXPECT_EQ(error_of({{0, 0, 0}, {1, 0, 0}}), "");
  EXPECT_EQ(error_of({{0, 0, 1}, {0, 0, 1e300}}), "");
  for (const Plane& plane :
       {Plane{{nan, 0, 0}, {1, 0, 0}}, Plane{{0.5, 0, 0}, {1, inf, 0}}, Plane{{0.5, 0, 0}, {0, 0, 0}},
        Plane{{1.001, 0, 0}, {1, 0, 0}}, Plane{{-0.001, 0, 0}, {1, 0, 0}}, Plane{{0, 0, 0}, {1, 1, 1}},
        Plane{{0, 0, 0}, {1, 1, 0}}, Plane{{1e300, 1e300, -1e300}, {1, 1, 1}}}) {
    const std::string found = error_of(plane);
    EXPECT_EQ(found.rfind("box.vtu: plane: expected", 0), 0u) << to_string(plane) << ": " << found;
    EXPECT_EQ(found.find('\n'), std::string::npos);
  }
}

TEST(CrossSectionPlane, FramesAreOrthonormalAndKeepTheOrderOfAxes) {
  for (const Plane& plane : test::trying_planes(50)) {
    const PlaneFrame frame = plane_frame(plane);
    EXPECT_NEAR(norm(frame.right), 1, 1e-14);
    EXPECT_NEAR(norm(frame.up), 1, 1e-14);
    EXPECT_NEAR(dot(frame.right, frame.up), 0, 1e-14);
    EXPECT_NEAR(dot(frame.right, plane.normal), 0, 1e-14 * norm(plane.normal));
    EXPECT_NEAR(dot(frame.up, plane.normal), 0, 1e-14 * norm(plane.normal));
    if (plane.axis()) continue;
    EXPECT_GT(dot(cross(frame.right, frame.up), plane.normal), 0);
    EXPECT_GE(frame.up.z, 0);
  }
  const Vec3 p{3, 4, 5};
  EXPECT_EQ(plane_frame(parse_plane("x=3")).coordinates(p), (std::array<double, 2>{4, 5}));
  EXPECT_EQ(plane_frame(parse_plane("y=4")).coordinates(p), (std::array<double, 2>{3, 5}));
  EXPECT_EQ(plane_frame({{}, {0, 0, -2}}).coordinates(p), (std::array<double, 2>{3, 4}));
  EXPECT_EQ(plane_frame(parse_plane("y=4")).right_name + plane_frame(parse_plane("y=4")).up_name, "xz");
}

TEST(CrossSectionPlane, ClippedPlanesHaveKnownAreas) {
  const double tiny = 1e-14;
  EXPECT_NEAR(polygon_area(clip_plane({{0.5, 0.5, 0.5}, {1, 1, 1}}, kUnit)), 0.75 * std::sqrt(3.0), tiny);
  EXPECT_NEAR(polygon_area(clip_plane({{0.5, 0.5, 0}, {1, -1, 0}}, kUnit)), std::sqrt(2.0), tiny);
  EXPECT_NEAR(polygon_area(clip_plane({{0.1, 0, 0}, {1, 1, 1}}, kUnit)), 0.01 * std::sqrt(3.0) / 2, tiny);
  const Box3 box{{1, 2, 3}, {2, 4, 6}};
  EXPECT_NEAR(polygon_area(clip_plane(parse_plane("x=1"), box)), 6, tiny);
  EXPECT_NEAR(polygon_area(clip_plane(parse_plane("y=4"), box)), 3, tiny);
  EXPECT_NEAR(polygon_area(clip_plane(parse_plane("z=3.3"), box)), 2, tiny);
  EXPECT_TRUE(clip_plane(parse_plane("z=2.9"), box).empty());
}

/// Returns boxes that fill the unit box, which is cut at random places; some of these are dyadic.
std::vector<Box3> random_boxes(std::mt19937_64& random) {
  std::array<std::vector<double>, 3> cuts;
  std::uniform_real_distribution<double> unit(0, 1);
  for (auto& x : cuts) {
    x = {0, 0.25, 0.5, 1};
    for (int i = 0; i < 3; ++i) x.push_back(unit(random));
    std::sort(x.begin(), x.end());
  }
  std::vector<Box3> boxes;
  for (std::size_t k = 1; k < cuts[2].size(); ++k) {
    for (std::size_t j = 1; j < cuts[1].size(); ++j) {
      for (std::size_t i = 1; i < cuts[0].size(); ++i)
        boxes.push_back(
            {{cuts[0][i - 1], cuts[1][j - 1], cuts[2][k - 1]}, {cuts[0][i], cuts[1][j], cuts[2][k]}});
    }
  }
  return boxes;
}

TEST(CrossSectionPlane, CutsOfBoxesFillTheCutOfTheWhole) {
  std::mt19937_64 random(7);
  for (const Plane& plane : test::trying_planes(100)) {
    const PlaneSides sides(plane, kUnit, "boxes");
    const double expected = polygon_area(clip_plane(plane, kUnit));
    double area = 0;
    std::vector<Vec3> corners;
    for (const Box3& box : random_boxes(random)) {
      cut_box(sides, box, corners);
      if (corners.empty()) continue;
      area += polygon_area(corners);
      Vec3 turn;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        turn += cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
        EXPECT_NEAR(dot(corners[i] - plane.origin, sides.normal()), 0, 1e-14);
      }
      EXPECT_GE(dot(turn, plane.normal), 0);
    }
    EXPECT_NEAR(area, expected, 1e-12 * expected) << to_string(plane);
  }
}

}  // namespace
}  // namespace adamas
