#include "core/distance/closest_point_forest.h"

#include <gtest/gtest.h>

#include <random>

#include "core/base/parallel.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {
namespace {

using test::random_point;

constexpr std::uint32_t kGroups = 37;

/// The group of a triangle: a few groups have most of the triangles, some have one or two, and one has none.
std::uint32_t group_of(std::uint32_t t) {
  if (t < 50) return t % (kGroups - 1);
  return t % 3;
}

struct Forest {
  explicit Forest(const InterfaceMesh& mesh)
      : forest(mesh.points, test::triangles_of(mesh), kGroups, group_of, sets()) {}
  static const std::vector<std::vector<std::uint32_t>>& sets() {
    static const std::vector<std::vector<std::uint32_t>> kSets = [] {
      std::vector<std::uint32_t> odd;
      for (std::uint32_t g = 1; g < kGroups; g += 2) odd.push_back(g);
      return std::vector<std::vector<std::uint32_t>>{odd, {0, 2}, {5}, {}, {kGroups - 1}};
    }();
    return kSets;
  }
  /// Which trees there are, with the rule that says whether a triangle is in the tree.
  struct Part {
    const ClosestPointTree* tree;
    std::vector<char> has_group;
    [[nodiscard]] bool has(std::uint32_t t) const { return has_group[group_of(t)] != 0; }
  };
  [[nodiscard]] std::vector<Part> parts() const {
    std::vector<Part> result{{&forest.all(), std::vector<char>(kGroups, 1)}};
    for (std::size_t g = 0; g < kGroups; ++g) {
      result.push_back({&forest.group(g), std::vector<char>(kGroups, 0)});
      result.back().has_group[g] = 1;
    }
    for (std::size_t s = 0; s < sets().size(); ++s) {
      result.push_back({&forest.set(s), std::vector<char>(kGroups, 0)});
      for (const std::uint32_t g : sets()[s]) result.back().has_group[g] = 1;
    }
    return result;
  }
  ClosestPointForest forest;
};

/// Finds the closest point of the triangles of a part, the first one among equals.
std::optional<ClosestPoint> brute_force(const ClosestPointForest& forest, const Forest::Part& part,
                                        const Vec3& q) {
  std::optional<ClosestPoint> best;
  for (std::uint32_t t = 0; t < forest.triangles().size(); ++t) {
    if (!part.has(t)) continue;
    const TrianglePoint p = closest_on_triangle(q, forest.corners(t));
    if (!best || p.squared_distance < best->squared_distance)
      best = {p.point, p.squared_distance, t, p.feature};
  }
  return best;
}

void expect_closest_of_parts(const ClosestPointForest& forest, const std::vector<Forest::Part>& parts,
                             const Vec3& q) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    SCOPED_TRACE(i);
    const auto expected = brute_force(forest, parts[i], q);
    const auto found = parts[i].tree->closest(q);
    ASSERT_EQ(found.has_value(), expected.has_value());
    if (!found) continue;
    EXPECT_EQ(found->squared_distance, expected->squared_distance);
    EXPECT_EQ(found->triangle, expected->triangle);
    EXPECT_EQ(found->feature, expected->feature);
    EXPECT_EQ(found->point, expected->point);
    EXPECT_FALSE(parts[i].tree->closest(q, 0.999999 * std::sqrt(expected->squared_distance)));
  }
}

TEST(ClosestPointForest, EachTreeHasTheTrianglesOfItsGroups) {
  constexpr std::uint32_t kCount = 5000;
  const Forest made(test::random_soup(3, kCount));
  for (const Forest::Part& part : made.parts()) {
    part.tree->validate();
    std::vector<std::uint32_t> expected;
    Box3 box;
    for (std::uint32_t t = 0; t < kCount; ++t) {
      if (!part.has(t)) continue;
      expected.push_back(t);
      for (const Vec3& p : made.forest.corners(t)) box.extend(p);
    }
    EXPECT_EQ(part.tree->indices(), expected);
    EXPECT_EQ(part.tree->size(), expected.size());
    EXPECT_EQ(part.tree->empty(), expected.empty());
    EXPECT_EQ(part.tree->bounds().min, box.min);
    EXPECT_EQ(part.tree->bounds().max, box.max);
  }
}

TEST(ClosestPointForest, GroupsOfATreeDivideIntoAllOfIt) {
  const Forest made(test::random_soup(4, 3000));
  for (const Forest::Part& part : made.parts()) {
    if (part.tree->empty()) continue;
    std::vector<std::uint32_t> found;
    std::vector<ClosestPointTree::Group> groups{part.tree->whole()};
    while (!groups.empty()) {
      const ClosestPointTree::Group group = groups.back();
      groups.pop_back();
      std::size_t outside = 0;
      part.tree->for_each_triangle(group, [&](std::uint32_t t) {
        for (const Vec3& p : made.forest.corners(t)) outside += group.box.contains(p) ? 0 : 1;
        if (ClosestPointTree::is_leaf(group)) found.push_back(t);
      });
      EXPECT_EQ(outside, 0u);
      if (!ClosestPointTree::is_leaf(group)) part.tree->divide(group, groups);
    }
    std::ranges::sort(found);
    EXPECT_EQ(found, part.tree->indices());
  }
}

TEST(ClosestPointForest, EqualsBruteForceOnRandomSoups) {
  for (const std::size_t count : {1u, 30u, 200u, 5000u}) {
    const Forest made(test::random_soup(count, count));
    const auto parts = made.parts();
    std::mt19937_64 random(count);
    for (int i = 0; i < 40; ++i)
      expect_closest_of_parts(
          made.forest, parts,
          random_point(random, i % 2 == 0 ? test::unit_box() : Box3{{-9, -9, -9}, {9, 9, 9}}));
  }
}

/// Each triangle occurs in several groups, and the points of a grid lie on many triangles.
TEST(ClosestPointForest, FindsTheLowestOfEquals) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_patch(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, MaterialId(0), MaterialId(1), 8);
  const auto once = mesh.triangles;
  for (int copy = 0; copy < 4; ++copy)
    mesh.triangles.insert(mesh.triangles.begin(), once.begin() + copy, once.end());
  const Forest made(mesh);
  const auto parts = made.parts();
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 8; ++j) expect_closest_of_parts(made.forest, parts, {i / 8.0, j / 8.0, 0.25});
  }
}

TEST(ClosestPointForest, RaysAndBoxesMeetTheTrianglesOfTheirGroups) {
  const Forest made(test::random_soup(8, 700));
  std::mt19937_64 random(9);
  std::vector<std::uint32_t> all, found, expected;
  for (int i = 0; i < 50; ++i) {
    const Vec3 p = random_point(random, test::unit_box()), d = random_point(random, test::unit_box()) - p;
    const Box3 box{p - Vec3{0.1, 0.1, 0.1}, p + Vec3{0.1, 0.1, 0.1}};
    made.forest.all().overlapping(box, all);
    for (const Forest::Part& part : made.parts()) {
      expected.clear();
      std::copy_if(all.begin(), all.end(), std::back_inserter(expected),
                   [&](std::uint32_t t) { return part.has(t); });
      part.tree->overlapping(box, found);
      EXPECT_EQ(found, expected);
      // The first hit of a part is the first one of all that is in the part.
      double reach = 0;
      std::optional<RayHit> hit;
      for (std::uint32_t ignore = ClosestPointTree::kNoTriangle; reach < 2; reach = hit->t) {
        const Vec3 from = p + reach * d;
        hit = made.forest.all().first_hit(from, d, 2 - reach, ignore);
        if (!hit) break;
        ignore = hit->triangle;
        hit->t += reach;
        if (part.has(hit->triangle)) break;
      }
      const auto own = part.tree->first_hit(p, d, 2);
      ASSERT_EQ(own.has_value(), hit.has_value());
      if (!own) continue;
      EXPECT_EQ(own->triangle, hit->triangle);
      EXPECT_NEAR(own->t, hit->t, 1e-9);
    }
  }
}

TEST(ClosestPointForest, IsTheSameOnAnyNumberOfThreads) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_sphere(mesh, {0, 0, 0}, 1, MaterialId(0), MaterialId(1), 120);
  std::vector<Vec3> results[2];
  for (const unsigned threads : {1u, 4u}) {
    set_thread_limit(threads);
    const Forest made(mesh);
    std::mt19937_64 random(4);
    for (int i = 0; i < 200; ++i) {
      const Vec3 q = random_point(random, {{-1, -1, -1}, {1, 1, 1}});
      for (const Forest::Part& part : made.parts()) {
        if (const auto closest = part.tree->closest(q)) results[threads / 4].push_back(closest->point);
      }
    }
  }
  set_thread_limit(0);
  EXPECT_EQ(results[0], results[1]);
}

/// Points take 12 bytes for each triangle of a closed surface, their indices as many, the order 4, and the
/// nodes, of which most are full, no more than 16.
TEST(ClosestPointForest, TakesLittleMemory) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_sphere(mesh, {0, 0, 0}, 1, MaterialId(0), MaterialId(1), 120);
  const ClosestPointForest forest(mesh.points, test::triangles_of(mesh));
  EXPECT_LE(static_cast<double>(forest.all().memory_bytes()),
            44.0 * static_cast<double>(mesh.triangles.size()));
  const std::vector<ClosestPointTree::Triangle> few(8, forest.triangles()[5]);
  const ClosestPointTree part(forest.points(), few);
  EXPECT_LE(part.memory_bytes(), 1000u);
  const Vec3 q{0.3, 0.2, 2};
  EXPECT_EQ(part.closest(q)->point, closest_on_triangle(q, forest.corners(5)).point);
}

}  // namespace
}  // namespace adamas
