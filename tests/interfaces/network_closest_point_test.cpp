#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>

#include <utility>

#include "core/base/parallel.h"
#include "core/distance/closest_point_tree.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {
namespace {

using test::random_point;
using test::Triangles;

struct Soup {
  explicit Soup(const InterfaceMesh& mesh)
      : points(mesh.points), triangles(test::triangles_of(mesh)), tree(points, triangles) {}
  [[nodiscard]] std::array<Vec3, 3> corners(std::size_t t) const {
    return {points[triangles[t][0]], points[triangles[t][1]], points[triangles[t][2]]};
  }
  [[nodiscard]] ClosestPoint brute_force(const Vec3& q) const {
    ClosestPoint best;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const TrianglePoint p = closest_on_triangle(q, corners(t));
      if (p.squared_distance < best.squared_distance) best = {p.point, p.squared_distance, t, p.feature};
    }
    return best;
  }
  std::vector<Vec3> points;
  Triangles triangles;
  ClosestPointTree tree;
};

void expect_same(const ClosestPoint& a, const ClosestPoint& b) {
  EXPECT_EQ(a.squared_distance, b.squared_distance);
  EXPECT_EQ(a.triangle, b.triangle);
  EXPECT_EQ(a.feature, b.feature);
  EXPECT_EQ(a.point, b.point);
}

TEST(TriangleDistance, IsLeastAmongManyWeights) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 2000; ++round) {
    std::array<Vec3, 3> c;
    for (Vec3& p : c) p = random_point(random, test::unit_box());
    if (round % 4 == 1) c[2] = 0.3 * c[0] + 0.7 * c[1];
    if (round % 4 == 2) c[2] = c[1];
    const Vec3 q = random_point(random, {{-1, -1, -1}, {2, 2, 2}});
    const TrianglePoint found = closest_on_triangle(q, c);
    EXPECT_NEAR(found.squared_distance, squared_norm(q - found.point), 1e-15);
    double least = 1e9;
    const int n = 24;
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const double u = 1.0 * i / n, v = 1.0 * j / n;
        least = std::min(least, distance(q, u * c[0] + v * c[1] + (1 - u - v) * c[2]));
      }
    }
    EXPECT_LE(std::sqrt(found.squared_distance), least + 1e-12);
    EXPECT_GE(std::sqrt(found.squared_distance), least - 2.0 / n);
  }
}

TEST(TriangleDistance, NamesTheFeature) {
  const std::array<Vec3, 3> c{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  EXPECT_EQ(closest_on_triangle({0.2, 0.2, 1}, c).feature, TriangleFeature::kFace);
  EXPECT_EQ(closest_on_triangle({0.5, -1, 1}, c).feature, TriangleFeature::kEdge0);
  EXPECT_EQ(closest_on_triangle({1, 1, 1}, c).feature, TriangleFeature::kEdge1);
  EXPECT_EQ(closest_on_triangle({-1, 0.5, 1}, c).feature, TriangleFeature::kEdge2);
  EXPECT_EQ(closest_on_triangle({-1, -1, 1}, c).feature, TriangleFeature::kVertex0);
  EXPECT_EQ(closest_on_triangle({3, 0, 1}, c).feature, TriangleFeature::kVertex1);
  EXPECT_EQ(closest_on_triangle({0, 3, 1}, c).feature, TriangleFeature::kVertex2);
}

TEST(ClosestPointTree, EqualsBruteForceOnRandomSoups) {
  for (const std::size_t count : {1u, 2u, 5u, 17u, 100u, 1500u}) {
    const Soup soup(test::random_soup(count, count));
    soup.tree.validate();
    std::mt19937_64 random(count);
    for (int i = 0; i < 400; ++i) {
      const Vec3 q = random_point(random, i % 2 == 0 ? test::unit_box() : Box3{{-9, -9, -9}, {9, 9, 9}});
      const ClosestPoint expected = soup.brute_force(q);
      const auto found = soup.tree.closest(q);
      ASSERT_TRUE(found);
      expect_same(*found, expected);
      const double d = std::sqrt(expected.squared_distance);
      EXPECT_TRUE(soup.tree.closest(q, d * 1.000001));
      EXPECT_FALSE(soup.tree.closest(q, d * 0.999999));
      expect_same(*soup.tree.closest_from(q, static_cast<std::uint32_t>(random() % count)), expected);
      EXPECT_TRUE(soup.tree.is_within(q, d * 1.000001));
      EXPECT_FALSE(soup.tree.is_within(q, d * 0.999999));
    }
  }
}

TEST(ClosestPointTree, EqualsBruteForceFarFromTheOriginAndAtAllScales) {
  for (const double scale : {1e-150, 1e-20, 1e-3, 1e6, 1e100}) {
    for (const double shift : {0.0, 1e3}) {
      InterfaceMesh mesh = test::random_soup(5, 300);
      for (Vec3& p : mesh.points) p = scale * (p + Vec3{shift, -shift, shift});
      const Soup soup(mesh);
      std::mt19937_64 random(2);
      for (int i = 0; i < 100; ++i) {
        const Vec3 q = scale * (random_point(random, test::unit_box()) + Vec3{shift, -shift, shift});
        expect_same(*soup.tree.closest(q), soup.brute_force(q));
      }
    }
  }
}

TEST(ClosestPointTree, FindsTheLowestOfEquals) {
  // Each triangle occurs four times, and the points of a grid lie on many triangles.
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_patch(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, MaterialId(0), MaterialId(1), 8);
  const auto once = mesh.triangles;
  for (int copy = 0; copy < 3; ++copy)
    mesh.triangles.insert(mesh.triangles.begin(), once.begin(), once.end());
  const Soup soup(mesh);
  for (int i = 0; i <= 16; ++i) {
    for (int j = 0; j <= 16; ++j) {
      const Vec3 q{i / 16.0, j / 16.0, 0.25};
      const auto found = soup.tree.closest(q);
      EXPECT_LT(found->triangle, once.size());
      expect_same(*found, soup.brute_force(q));
    }
  }
}

TEST(ClosestPointTree, CopesWithCoincidingAndLopsidedTriangles) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const double x = std::pow(2.0, -0.3 * std::min(i, 900u));
    mesh.points.push_back({x, 0, 0});
    mesh.points.push_back({x, x, 0});
    mesh.points.push_back({x, 0, x});
    mesh.triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}, MaterialId(0), MaterialId(1)});
  }
  const Soup soup(mesh);
  soup.tree.validate();
  for (const double x : {0.0, 1e-60, 1e-9, 0.4, 2.0})
    expect_same(*soup.tree.closest({x, x, x}), soup.brute_force({x, x, x}));
}

TEST(ClosestPointTree, AnswersOddQuestions) {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(ClosestPointTree().closest({0, 0, 0}));
  EXPECT_FALSE(ClosestPointTree().first_hit({0, 0, 0}, {1, 0, 0}));
  const Soup soup(test::random_soup(3, 50));
  EXPECT_FALSE(soup.tree.closest({nan, 0, 0}));
  EXPECT_FALSE(soup.tree.closest({infinity, 0, 0}));
  EXPECT_FALSE(soup.tree.closest({0, 0, 0}, -1));
  EXPECT_FALSE(soup.tree.closest({0, 0, 0}, nan));
  EXPECT_FALSE(soup.tree.is_within({nan, 0, 0}, infinity));
  EXPECT_FALSE(soup.tree.is_within({0, 0, 0}, nan));
  EXPECT_FALSE(ClosestPointTree().is_within({0, 0, 0}, infinity));
  EXPECT_TRUE(soup.tree.closest({1e30, 0, 0}));
  const Vec3 corner = soup.points[0];
  EXPECT_EQ(soup.tree.closest(corner, 0)->squared_distance, 0);
}

TEST(ClosestPointTree, DistancesAreThoseOfCgal) {
  using Kernel = CGAL::Simple_cartesian<double>;
  using List = std::vector<Kernel::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, List::const_iterator>;
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_sphere(mesh, {0, 0, 0}, 1, MaterialId(0), MaterialId(1), 20);
  const Soup soup(mesh);
  List list;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const auto c = soup.corners(t);
    const auto point = [](const Vec3& p) { return Kernel::Point_3(p.x, p.y, p.z); };
    list.emplace_back(point(c[0]), point(c[1]), point(c[2]));
  }
  const CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> theirs(list.begin(), list.end());
  std::mt19937_64 random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 q = random_point(random, {{-2, -2, -2}, {2, 2, 2}});
    EXPECT_NEAR(std::sqrt(soup.tree.closest(q)->squared_distance),
                std::sqrt(theirs.squared_distance({q.x, q.y, q.z})), 1e-13);
  }
}

TEST(ClosestPointTree, IsTheSameOnAnyNumberOfThreads) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_sphere(mesh, {0, 0, 0}, 1, MaterialId(0), MaterialId(1), 120);
  std::vector<ClosestPoint> results[2];
  for (const unsigned threads : {1u, 4u}) {
    set_thread_limit(threads);
    const Soup soup(mesh);
    soup.tree.validate();
    std::mt19937_64 random(4);
    for (int i = 0; i < 500; ++i) {
      results[threads / 4].push_back(*soup.tree.closest(random_point(random, {{-1, -1, -1}, {1, 1, 1}})));
    }
  }
  set_thread_limit(0);
  for (std::size_t i = 0; i < results[0].size(); ++i) expect_same(results[0][i], results[1][i]);
}

/// Intersects a ray with a triangle by the formula of Moeller and Trumbore, which is independent of the
/// tree's.
std::optional<double> ray_hit(const Vec3& o, const Vec3& d, const std::array<Vec3, 3>& c) {
  const Vec3 e1 = c[1] - c[0], e2 = c[2] - c[0], p = cross(d, e2);
  const double det = dot(e1, p);
  if (std::abs(det) < 1e-14) return std::nullopt;
  const Vec3 s = o - c[0], q = cross(s, e1);
  const double u = dot(s, p) / det, v = dot(d, q) / det, t = dot(e2, q) / det;
  if (u < 0 || v < 0 || u + v > 1 || t < 0) return std::nullopt;
  return t;
}

TEST(ClosestPointTree, RaysHitWhatBruteForceHits) {
  const Soup soup(test::random_soup(11, 800));
  std::mt19937_64 random(12);
  int hits = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 o = random_point(random, {{-1, -1, -1}, {2, 2, 2}});
    const Vec3 d = random_point(random, test::unit_box()) - o;
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t which = ClosestPointTree::kNoTriangle;
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
      const auto hit = ray_hit(o, d, soup.corners(t));
      if (hit && *hit < least) least = *hit, which = t;
    }
    const auto found = soup.tree.first_hit(o, d);
    ASSERT_EQ(found.has_value(), which != ClosestPointTree::kNoTriangle);
    if (!found) continue;
    ++hits;
    EXPECT_EQ(found->triangle, which);
    EXPECT_NEAR(found->t, least, 1e-9);
    EXPECT_FALSE(soup.tree.first_hit(o, d, 0.999 * least));
    const auto next = soup.tree.first_hit(o, d, std::numeric_limits<double>::infinity(), which);
    if (next) {
      EXPECT_GE(next->t, found->t);
      EXPECT_NE(next->triangle, which);
    }
  }
  EXPECT_GT(hits, 300);
}

TEST(ClosestPointTree, NoRayEscapesAClosedSurface) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_sphere(mesh, {0, 0, 0}, 1, MaterialId(0), MaterialId(1), 10);
  const Soup soup(mesh);
  // Rays from the centre, and from another point, pass through all corners and the middles of all edges.
  for (const Vec3& origin : {Vec3{0, 0, 0}, Vec3{0.1, -0.2, 0.05}}) {
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
      const auto c = soup.corners(t);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_TRUE(soup.tree.first_hit(origin, c[k] - origin));
        EXPECT_TRUE(soup.tree.first_hit(origin, 0.5 * (c[k] + c[(k + 1) % 3]) - origin));
      }
    }
  }
}

TEST(ClosestPointTree, BoxesOverlapWhatComesCloseToTheirInside) {
  const Soup soup(test::random_soup(21, 600));
  std::mt19937_64 random(22);
  std::vector<std::uint32_t> found;
  for (int i = 0; i < 200; ++i) {
    const Vec3 center = random_point(random, test::unit_box());
    const double half = 0.002 + 0.2 * std::pow(random_point(random, test::unit_box()).x, 3);
    const Box3 box{center - Vec3{half, half, half}, center + Vec3{half, half, half}};
    soup.tree.overlapping(box, found);
    EXPECT_EQ(soup.tree.any_overlap(box), !found.empty());
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
      const auto c = soup.corners(t);
      // Alternating projections converge to a common point of two convex sets, or to the closest pair.
      Vec3 p = c[0];
      double gap = 1;
      for (int step = 0; step < 400; ++step) {
        Vec3 in_box;
        for (int axis = 0; axis < 3; ++axis) in_box[axis] = std::clamp(p[axis], box.min[axis], box.max[axis]);
        const Vec3 last = std::exchange(p, closest_on_triangle(in_box, c).point);
        gap = distance(p, in_box);
        if (p == last) break;
      }
      const bool listed = std::binary_search(found.begin(), found.end(), t);
      if (gap < 1e-12) {
        EXPECT_TRUE(listed) << t;
      }
      if (gap > 1e-3) {
        EXPECT_FALSE(listed) << t;
      }
    }
  }
}

}  // namespace
}  // namespace adamas
