#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>

#include "core/base/error.h"
#include "core/lattice/domain.h"
#include "tests/support/mesh_laws.h"

namespace adamas {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string message_of(const Box3& box, std::array<int, 3> roots) {
  try {
    const Domain domain(box, roots);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Domain, BadBoxesAreRefusedInOneLine) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const auto& [low, high] : {std::pair{1.0, 1.0},
                                    {1.0, 0.0},
                                    {kNan, 1.0},
                                    {0.0, kNan},
                                    {-kInfinity, 0.0},
                                    {0.0, kInfinity},
                                    {0.0, 1e-200},
                                    {0.0, 1e200},
                                    {1e16, 1e16 + 2}}) {
      Box3 box{{0, 0, 0}, {1, 1, 1}};
      box.min[axis] = low;
      box.max[axis] = high;
      const std::string message = message_of(box, {1, 1, 1});
      EXPECT_NE(message.find("domain: expected"), std::string::npos) << low << " " << high;
      EXPECT_NE(message.find(std::string("found ") + "xyz"[axis]), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos);
      EXPECT_THROW(Domain::fit(box), Error);
    }
  }
  EXPECT_NE(message_of(Box3(), {1, 1, 1}), "");
}

TEST(Domain, SidesOfOtherOrdersAreRefused) {
  for (int axis = 0; axis < 3; ++axis) {
    Box3 box{{0, 0, 0}, {1, 1, 1}};
    for (const double side : {1e8, 1e-8}) {
      box.max[axis] = side;
      EXPECT_EQ(message_of(box, {1, 1, 1}), "");
    }
    for (const double side : {1.01e8, 0.99e-8, 1e20}) {
      box.max[axis] = side;
      EXPECT_NE(message_of(box, {1, 1, 1}).find("none is more than 1e+08 times"), std::string::npos) << side;
    }
  }
}

TEST(Domain, BadNumbersOfRootsAreRefused) {
  const Box3 box{{0, 0, 0}, {1, 1, 1}};
  EXPECT_NE(message_of(box, {1, 0, 1}).find("found 0 along y"), std::string::npos);
  EXPECT_NE(message_of(box, {1, 1, -3}).find("found -3 along z"), std::string::npos);
  EXPECT_NE(message_of(box, {Domain::kMaxRoots + 1, 1, 1}).find("found 65 along x"), std::string::npos);
  EXPECT_EQ(message_of(box, {Domain::kMaxRoots, 1, 1}), "");
}

TEST(Domain, CornersAreExact) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(-1000, 1000), side(1e-3, 1000);
  for (int round = 0; round < 1000; ++round) {
    const Vec3 low{at(random), at(random), at(random)};
    const Box3 box{low, low + Vec3{side(random), side(random), side(random)}};
    const Domain domain(box, {1 + round % 5, 1 + round % 3, 1 + round % 7});
    EXPECT_EQ(domain.position({0, 0, 0}), box.min);
    EXPECT_EQ(domain.position(domain.extent()), box.max);
    EXPECT_EQ(domain.position({domain.extent().i, 0, domain.extent().k}),
              (Vec3{box.max.x, box.min.y, box.max.z}));
  }
}

TEST(Domain, PositionsOfNeighboursAtTheGreatestDepthDiffer) {
  for (const double offset : {0.0, 1.0, -1e3, 1e6, 1e9, 1e12}) {
    const Box3 box{{offset, offset, offset}, {offset + 1, offset + 2, offset + 3}};
    const Domain domain(box, {1, 2, 3});
    EXPECT_EQ(domain.depth(), offset < 1e6 ? kRootBits - 1 : domain.depth());
    const int step = 1 << (kRootBits - 1 - domain.depth());
    for (int axis = 0; axis < 3; ++axis) {
      LatticePoint p = domain.extent(), q = p;
      q[axis] -= step;
      const double expected = step * domain.spacing()[axis];
      EXPECT_NEAR(domain.position(p)[axis] - domain.position(q)[axis], expected, 0.01 * expected);
    }
  }
}

TEST(Domain, FitMakesRootsNearlyCubic) {
  const auto roots = [](Vec3 size, int max_roots = 32) {
    return Domain::fit({{-1, 0, 3}, Vec3{-1, 0, 3} + size}, max_roots).roots();
  };
  using Roots = std::array<int, 3>;
  EXPECT_EQ(Domain::fit({{0, 0, -16}, {12, 12, 4.8}}).roots(), (Roots{1, 1, 2}));
  EXPECT_EQ(roots({1, 1, 1}), (Roots{1, 1, 1}));
  EXPECT_EQ(roots({0.1, 0.1, 0.1}), (Roots{1, 1, 1}));
  EXPECT_EQ(roots({3, 1, 2}), (Roots{3, 1, 2}));
  EXPECT_EQ(roots({1, 1, 1000}), (Roots{1, 1, 32}));
  EXPECT_EQ(roots({1, 1, 1000}, 5), (Roots{1, 1, 5}));
  EXPECT_EQ(roots({5, 5, 0.5}), (Roots{10, 10, 1}));
  EXPECT_EQ(roots({1, 7, 1}, 1), (Roots{1, 1, 1}));
}

TEST(Domain, ContainsAndCorners) {
  const Domain domain({{0, 0, 0}, {1, 1, 1}}, {2, 1, 3});
  const int side = 1 << kRootBits;
  EXPECT_TRUE(domain.contains({2 * side, side, 3 * side}));
  EXPECT_FALSE(domain.contains({2 * side + 1, side, 3 * side}));
  EXPECT_FALSE(domain.contains({0, -1, 0}));
  EXPECT_TRUE(test::is_root_corner(domain, {0, 0, 0}));
  EXPECT_TRUE(test::is_root_corner(domain, {side, side, 2 * side}));
  EXPECT_FALSE(test::is_root_corner(domain, {side, side / 2, 2 * side}));
  EXPECT_FALSE(test::is_root_corner(domain, {3 * side, 0, 0}));
  EXPECT_DOUBLE_EQ(domain.diameter({side, 0, 0}), norm({0.5, 1, 1. / 3}));
}

}  // namespace
}  // namespace adamas
