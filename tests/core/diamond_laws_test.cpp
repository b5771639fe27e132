#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/lattice/diamond.h"
#include "core/lattice/domain.h"
#include "tests/support/bisection_reference.h"
#include "tests/support/mesh_laws.h"

namespace adamas {
namespace {

std::int64_t six_volumes(const std::array<LatticePoint, 4>& t, int bits) {
  const auto e = [&](std::size_t v, int axis) { return std::int64_t{(t[v][axis] - t[0][axis]) >> bits}; };
  return e(1, 0) * (e(2, 1) * e(3, 2) - e(2, 2) * e(3, 1)) +
         e(1, 1) * (e(2, 2) * e(3, 0) - e(2, 0) * e(3, 2)) +
         e(1, 2) * (e(2, 0) * e(3, 1) - e(2, 1) * e(3, 0));
}

template <class List>
std::set<LatticePoint> as_set(const List& list) {
  return {list.begin(), list.end()};
}

Domain unit_domain(std::array<int, 3> roots) { return {{{0, 0, 0}, {1, 1, 1}}, roots}; }

struct Scene {
  std::array<int, 3> roots;
  int depth;
};

/// Visits every diamond above `depth` of a domain together with the same diamond found by brute force.
class DiamondLaws : public testing::TestWithParam<Scene> {
 protected:
  template <class Check>
  void for_each_diamond(Check&& check) const {
    for (const auto& [p, expected] : reference.diamonds()) {
      if (expected.level < GetParam().depth) check(Diamond(p), expected);
      if (HasFailure()) {
        ADD_FAILURE() << "at " << p.i << " " << p.j << " " << p.k;
        return;
      }
    }
  }
  const Domain domain = unit_domain(GetParam().roots);
  const test::BisectionReference reference{GetParam().roots, 3 * GetParam().depth};
};

TEST_P(DiamondLaws, EveryLatticePointButRootCornersIsOneDiamond) {
  const int cells = 1 << GetParam().depth, step = 1 << (kRootBits - GetParam().depth);
  const auto [a, b, c] = GetParam().roots;
  std::size_t diamonds = 0;
  for_each_diamond([&](const Diamond&, const test::ReferenceDiamond&) { ++diamonds; });
  for (int i = 0; i <= a * cells; ++i) {
    for (int j = 0; j <= b * cells; ++j) {
      for (int k = 0; k <= c * cells; ++k) {
        const LatticePoint p{i * step, j * step, k * step};
        const auto found = reference.diamonds().find(p);
        const bool is_diamond = found != reference.diamonds().end() && found->second.level < GetParam().depth;
        ASSERT_EQ(is_diamond, !test::is_root_corner(domain, p)) << i << " " << j << " " << k;
      }
    }
  }
  EXPECT_EQ(diamonds, static_cast<std::size_t>((a * cells + 1) * (b * cells + 1) * (c * cells + 1) -
                                               (a + 1) * (b + 1) * (c + 1)));
}

TEST_P(DiamondLaws, PhaseLevelAndSplitEdgeFollowFromTheBits) {
  for_each_diamond([](const Diamond& d, const test::ReferenceDiamond& expected) {
    EXPECT_EQ(d.phase(), expected.phase);
    EXPECT_EQ(d.level(), expected.level);
    EXPECT_EQ(as_set(d.split_edge()), as_set(expected.split_edge));
  });
}

TEST_P(DiamondLaws, PhaseTable) {
  constexpr std::array<int, 3> kTetrahedra{6, 4, 8}, kParents{3, 2, 4}, kChildren{6, 4, 8};
  for_each_diamond([&](const Diamond& d, const test::ReferenceDiamond& expected) {
    const auto phase = static_cast<std::size_t>(expected.phase);
    EXPECT_EQ(d.tetrahedron_count(), kTetrahedra[phase]);
    EXPECT_EQ(d.child_count(), kChildren[phase]);
    EXPECT_EQ(d.parent_count(), d.level() == 0 && phase == 0 ? 0 : kParents[phase]);
    for (int c = 0; c < d.child_count(); ++c) {
      const Diamond child(d.child(c));
      EXPECT_EQ(child.phase(), (d.phase() + 1) % 3);
      EXPECT_EQ(child.level(), d.level() + (d.phase() == 2 ? 1 : 0));
      EXPECT_EQ(child.type_index(), d.type().child_types[static_cast<std::size_t>(c)]);
    }
  });
}

TEST_P(DiamondLaws, ClippedTetrahedraAreThoseOfBruteForce) {
  for_each_diamond([&](const Diamond& d, const test::ReferenceDiamond& expected) {
    std::set<test::ReferenceTetrahedron> tetrahedra;
    for (const int slot : d.tetrahedra(domain)) tetrahedra.insert(test::sorted(d.tetrahedron(slot)));
    EXPECT_EQ(tetrahedra, expected.tetrahedra);
    EXPECT_EQ(static_cast<std::size_t>(d.tetrahedron_count(domain)), expected.tetrahedra.size());
  });
}

TEST_P(DiamondLaws, ClippedChildrenAndParentsAreThoseOfBruteForceAndMutual) {
  for_each_diamond([&](const Diamond& d, const test::ReferenceDiamond& expected) {
    EXPECT_EQ(as_set(d.children(domain)), expected.children);
    EXPECT_EQ(as_set(d.parents(domain)), expected.parents);
    for (int c = 0; c < d.child_count(); ++c) {
      const Diamond child(d.child(c));
      bool mutual = false;
      for (int x = 0; x < child.parent_count(); ++x) mutual = mutual || child.parent(x) == d.point();
      EXPECT_TRUE(mutual);
    }
  });
}

TEST_P(DiamondLaws, TetrahedraShareTheSplitEdgeAndFillTheHull) {
  // These are six times the volumes of the cube and of the two double pyramids on a square, in units of the
  // scale cubed.
  constexpr std::array<std::int64_t, 3> kHull{48, 16, 16};
  for_each_diamond([&](const Diamond& d, const test::ReferenceDiamond&) {
    std::int64_t sum = 0;
    const auto [a, b] = d.split_edge();
    for (int slot = 0; slot < d.tetrahedron_count(); ++slot) {
      const auto t = d.tetrahedron(slot);
      EXPECT_EQ(t[0], a);
      EXPECT_EQ(t[1], b);
      EXPECT_EQ(t[3], d.tetrahedron((slot + 1) % d.tetrahedron_count())[2]);
      EXPECT_GT(six_volumes(t, d.scale_bits()), 0);
      sum += six_volumes(t, d.scale_bits());
    }
    EXPECT_EQ(sum, kHull[static_cast<std::size_t>(d.phase())]);
  });
}

TEST_P(DiamondLaws, PhaseZeroPointsToTheParentCube) {
  for_each_diamond([](const Diamond& d, const test::ReferenceDiamond&) {
    if (d.phase() != 0 || d.level() == 0) return;
    const Diamond centre(d.split_edge()[1]);
    EXPECT_EQ(centre.phase(), 0);
    EXPECT_EQ(centre.level(), d.level() - 1);
  });
}

TEST_P(DiamondLaws, EveryTetrahedronThatTouchesAPointIsSmallerThanItsDiameter) {
  const auto roots = GetParam().roots;
  for (const Vec3 size : {Vec3{1, 1, 1}, Vec3{1, 2.5, 0.3}, Vec3{7, 0.1, 3}}) {
    const Domain box({{-1, 2, 5}, Vec3{-1, 2, 5} + size}, roots);
    std::map<LatticePoint, double> greatest;
    const auto measure = [&](const test::ReferenceTetrahedron& t) {
      double diameter = 0;
      for (const LatticePoint p : t) {
        for (const LatticePoint q : t)
          diameter = std::max(diameter, distance(box.position(p), box.position(q)));
      }
      for (const LatticePoint p : t) greatest[p] = std::max(greatest[p], diameter);
    };
    // The tetrahedra round a point that a mesh can have are those that arise once it is a vertex.
    for_each_diamond([&](const Diamond& d, const test::ReferenceDiamond& expected) {
      for (const test::ReferenceTetrahedron& t : expected.tetrahedra) measure(t);
      double hull = 0;
      for (int x = 0; x < d.tetrahedron_count(); ++x) {
        for (const LatticePoint p : d.tetrahedron(x)) {
          for (int y = 0; y < d.tetrahedron_count(); ++y) {
            for (const LatticePoint q : d.tetrahedron(y)) {
              hull = std::max(hull, distance(box.position(p), box.position(q)));
            }
          }
        }
      }
      EXPECT_NEAR(box.diameter(d.point()), hull, 1e-12 * hull);
    });
    for (const auto& [p, diameter] : greatest) EXPECT_LE(diameter, box.diameter(p) * (1 + 1e-12));
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, DiamondLaws,
                         testing::Values(Scene{{1, 1, 1}, 4}, Scene{{2, 1, 3}, 3}, Scene{{3, 3, 2}, 2}));

TEST(DiamondTypes, EightTwelveAndSix) {
  std::array<int, 3> counts{};
  std::set<LatticePoint> directions;
  for (const DiamondType& type : kDiamondTypes) {
    ++counts[static_cast<std::size_t>(type.phase)];
    directions.insert(type.direction);
  }
  EXPECT_EQ(counts, (std::array<int, 3>{8, 12, 6}));
  EXPECT_EQ(directions.size(), 26u);
}

TEST(DiamondTypes, DihedralAnglesLieBetween45And120Degrees) {
  double least = 180, greatest = 0;
  for (const DiamondType& type : kDiamondTypes) {
    const Diamond d(LatticePoint{8, 8, 8} + type.direction);
    for (int slot = 0; slot < d.tetrahedron_count(); ++slot) {
      std::array<Vec3, 4> x;
      for (std::size_t v = 0; v < 4; ++v) {
        const LatticePoint p = d.tetrahedron(slot)[v];
        x[v] = {static_cast<double>(p.i), static_cast<double>(p.j), static_cast<double>(p.k)};
      }
      for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = 0; b < 4; ++b) {
          if (a == b) continue;
          const std::size_t c = a == 0 || b == 0 ? (a == 1 || b == 1 ? 2 : 1) : 0, e = 6 - a - b - c;
          const Vec3 axis = normalized(x[b] - x[a]);
          const Vec3 u = normalized((x[c] - x[a]) - dot(x[c] - x[a], axis) * axis);
          const Vec3 v = normalized((x[e] - x[a]) - dot(x[e] - x[a], axis) * axis);
          const double angle = std::acos(std::clamp(dot(u, v), -1.0, 1.0)) * 180 / std::numbers::pi;
          least = std::min(least, angle);
          greatest = std::max(greatest, angle);
        }
      }
    }
  }
  EXPECT_NEAR(least, 45, 1e-9);
  EXPECT_NEAR(greatest, 120, 1e-9);
}

}  // namespace
}  // namespace adamas
