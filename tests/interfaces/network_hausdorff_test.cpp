#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/distance/hausdorff.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {
namespace {

using test::Triangles;

struct Surface {
  explicit Surface(const InterfaceMesh& mesh)
      : points(mesh.points), triangles(test::triangles_of(mesh)), tree(points, triangles) {}
  [[nodiscard]] Vec3 at(std::size_t t, double u, double v) const {
    const auto& p = triangles[t];
    return u * points[p[0]] + v * points[p[1]] + (1 - u - v) * points[p[2]];
  }
  std::vector<Vec3> points;
  Triangles triangles;
  ClosestPointTree tree;
};

/// Samples every triangle densely and expects that no sample is farther than the bounds.
void expect_bounds_hold(const Surface& from, const Surface& to, const HausdorffOptions& options) {
  const DistanceBound bound = directed_distance_bound({from.points, from.triangles}, to.tree, options);
  double sampled = 0;
  const int n = 12;
  for (std::size_t t = 0; t < from.triangles.size(); ++t) {
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const Vec3 p = from.at(t, 1.0 * i / n, 1.0 * j / n);
        if (options.domain && !options.domain->contains(p)) continue;
        const double d = std::sqrt(to.tree.closest(p)->squared_distance);
        sampled = std::max(sampled, d);
        EXPECT_LE(d, bound.triangle_upper[t] + 1e-13);
      }
    }
  }
  EXPECT_LE(sampled, bound.upper + 1e-13);
  EXPECT_LE(bound.lower, bound.upper);
  EXPECT_NEAR(bound.lower, std::sqrt(to.tree.closest(bound.worst)->squared_distance), 1e-13);
  const double accept = options.accept > 0 ? options.accept : 1e-4 * to.tree.bounds().diagonal();
  EXPECT_LE(bound.upper, std::max(accept, (1 + options.relative) * bound.lower) + 1e-13);
  if (options.domain) {
    EXPECT_TRUE(options.domain->contains(bound.worst));
  }
}

TEST(Hausdorff, BoundsHoldOnRandomSoups) {
  HausdorffOptions options;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Surface from(test::random_soup(seed, 60)), to(test::random_soup(seed + 50, 40));
    options.domain.reset();
    options.relative = seed % 2 == 0 ? 0.05 : 0.5;
    expect_bounds_hold(from, to, options);
    options.domain = Box3{{0.2, 0.2, 0.2}, {0.7, 0.8, 0.6}};
    expect_bounds_hold(from, to, options);
  }
}

TEST(Hausdorff, BoundsHoldBetweenSpheres) {
  const MaterialId a(0), b(1);
  InterfaceMesh coarse = test::mesh_with_materials(2), fine = coarse, shifted = coarse;
  test::add_sphere(coarse, {0, 0, 0}, 1, a, b, 9);
  test::add_sphere(fine, {0, 0, 0}, 1, a, b, 20);
  test::add_sphere(shifted, {0.125, 0, 0}, 1, a, b, 20);
  const HausdorffOptions options;
  expect_bounds_hold(Surface(coarse), Surface(fine), options);
  expect_bounds_hold(Surface(fine), Surface(coarse), options);
  const Surface x(fine), y(shifted);
  const DistanceBound moved = directed_distance_bound({y.points, y.triangles}, x.tree);
  EXPECT_GT(moved.upper, 0.125 * 0.98);
  EXPECT_LT(moved.lower, 0.126);
}

TEST(Hausdorff, KnownDistances) {
  const MaterialId a(0), b(1);
  InterfaceMesh low = test::mesh_with_materials(2), high = low, tilted = low;
  test::add_patch(low, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, a, b, 5);
  test::add_patch(high, {0, 0, 0.25}, {1, 0, 0}, {0, 1, 0}, a, b, 3);
  test::add_patch(tilted, {0, 0, 0}, {1, 0, 0.5}, {0, 1, 0}, a, b, 7);
  const Surface floor(low), lid(high), ramp(tilted);
  EXPECT_LT(directed_distance_bound({floor.points, floor.triangles}, floor.tree).upper, 1e-15);
  const DistanceBound parallel = directed_distance_bound({lid.points, lid.triangles}, floor.tree);
  EXPECT_NEAR(parallel.lower, 0.25, 1e-15);
  EXPECT_GE(parallel.upper, 0.25);
  EXPECT_LE(parallel.upper, 0.25 * 1.05);
  const DistanceBound rising = directed_distance_bound({ramp.points, ramp.triangles}, floor.tree);
  EXPECT_NEAR(rising.lower, 0.5, 1e-12);
  EXPECT_LE(rising.upper, 0.525);
  HausdorffOptions options;
  options.domain = Box3{{0, 0, -1}, {0.5, 1, 1}};
  EXPECT_NEAR(directed_distance_bound({ramp.points, ramp.triangles}, floor.tree, options).lower, 0.25, 1e-12);
  EXPECT_EQ(directed_distance_bound({lid.points, lid.triangles}, ClosestPointTree()).upper,
            std::numeric_limits<double>::infinity());
  EXPECT_EQ(directed_distance_bound({lid.points, {}}, floor.tree).upper, 0);
}

/// Triangles of one plane are bounded together: there are no small pieces along their common edges, however
/// small the accepted distance is.
TEST(Hausdorff, CoplanarTrianglesNeedFewPieces) {
  const MaterialId a(0), b(1);
  const Vec3 corner{0.3, -0.2, 0.1}, across{2, 1, 0.5}, up{-0.5, 1.5, 0.25};
  InterfaceMesh coarse = test::mesh_with_materials(2), fine = coarse, bent = coarse;
  test::add_patch(coarse, corner, across, up, a, b, 5);
  test::add_patch(fine, corner, across, up, a, b, 7);
  test::add_patch(bent, corner, across, up, a, b, 7);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> shift(-1e-4, 1e-4);
  for (Vec3& p : bent.points) p = p + Vec3{shift(random), shift(random), shift(random)};
  const Surface from(coarse), to(fine), near(bent);
  HausdorffOptions options;
  options.accept = 1e-9;
  options.most_pieces = 40 * from.triangles.size();
  expect_bounds_hold(from, to, options);
  EXPECT_LT(directed_distance_bound({from.points, from.triangles}, to.tree, options).upper, 1e-14);
  EXPECT_LT(directed_distance_bound({to.points, to.triangles}, from.tree, options).upper, 1e-14);
  options.accept = 0.02;
  expect_bounds_hold(from, near, options);
}

TEST(Hausdorff, AcceptedTrianglesAreThoseWithinTheTarget) {
  const MaterialId a(0), b(1);
  InterfaceMesh coarse = test::mesh_with_materials(2), fine = coarse;
  test::add_sphere(coarse, {0, 0, 0}, 1, a, b, 8);
  test::add_sphere(fine, {0, 0, 0}, 1, a, b, 40);
  const Surface from(coarse), to(fine);
  HausdorffOptions options;
  options.relative = 0;
  options.accept = 0.5;
  EXPECT_LE(directed_distance_bound({from.points, from.triangles}, to.tree, options).upper, 0.5);
  options.accept = 1e-3;
  options.most_pieces = 30000;
  const DistanceBound cut_short = directed_distance_bound({from.points, from.triangles}, to.tree, options);
  options.most_pieces = 0;
  const DistanceBound shortest = directed_distance_bound({from.points, from.triangles}, to.tree, options);
  EXPECT_LE(cut_short.upper, shortest.upper);
  EXPECT_GE(shortest.upper, cut_short.lower);
}

/// The triangles of a tree are bounded in groups where that serves: their bounds hold, and the same triangles
/// are within the target as when each is examined.
TEST(Hausdorff, GroupsOfTrianglesAreBoundedAsEachOfThem) {
  const MaterialId a(0), b(1);
  std::mt19937_64 random(3);
  for (int round = 0; round < 12; ++round) {
    InterfaceMesh mesh = test::mesh_with_materials(2), other = mesh;
    test::add_sphere(mesh, {0, 0, 0}, 1, a, b, 40);
    test::add_sphere(other, {0.04 * round, 0, 0}, 1, a, b, 9 + round);
    std::uniform_real_distribution<double> bump(0, 0.03);
    for (Vec3& p : mesh.points) p = (1 + bump(random)) * p;
    const Surface from(mesh), to(other);
    HausdorffOptions options;
    options.each = true;
    options.relative = 0.005;
    options.accept = 0.15 + 0.03 * round;
    if (round % 3 == 0) options.domain = Box3{{-0.5, -0.9, -2}, {0.7, 0.8, 2}};
    const DistanceBound groups = directed_distance_bound(TriangleList(from.tree), to.tree, options);
    const DistanceBound each = directed_distance_bound({from.points, from.triangles}, to.tree, options);
    std::size_t looser = 0;
    for (std::size_t t = 0; t < from.triangles.size(); ++t) {
      EXPECT_GE(groups.triangle_upper[t], each.triangle_lower[t] - 1e-13);
      EXPECT_EQ(groups.triangle_upper[t] <= options.accept, each.triangle_upper[t] <= options.accept);
      looser += groups.triangle_lower[t] < each.triangle_lower[t] ? 1 : 0;
    }
    EXPECT_GT(looser, from.triangles.size() / 8) << "groups are expected to be bounded together";
  }
}

/// Where only triangles of a part of the surface are closest, the bounds are those from that part.
TEST(Hausdorff, ServedTrianglesAreBoundedAsFromThePartThatServes) {
  HausdorffOptions options;
  options.each = true;
  options.relative = 0.01;
  options.accept = 0.05;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    const Surface from(test::random_soup(seed, 60)), to(test::random_soup(seed + 50, 60));
    const std::uint32_t few = 45;
    const ClosestPointTree part(to.points, std::span(to.triangles).first(few));
    const TriangleList list(from.points, from.triangles);
    std::vector<std::uint32_t> places;
    for (std::uint32_t place = 0; place < list.size(); place += 1 + place % 2) places.push_back(place);
    const auto serves = [&](std::uint32_t place, std::uint32_t found) {
      return std::ranges::binary_search(places, place) && found < few;
    };
    const DistanceBound bound = bound_served_triangles(list, places, to.tree, serves, options);
    const DistanceBound expected = directed_distance_bound(list, part, options);
    std::size_t served = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!std::isfinite(bound.triangle_upper[i])) continue;
      ++served;
      EXPECT_EQ(bound.triangle_upper[i], expected.triangle_upper[places[i]]) << i;
      EXPECT_EQ(bound.triangle_lower[i], expected.triangle_lower[places[i]]) << i;
    }
    EXPECT_GT(served, 0u);
    EXPECT_LT(served, places.size());
  }
}

TEST(Hausdorff, EachTriangleIsBoundedByWhatIsFarOfItsOwn) {
  HausdorffOptions options;
  options.each = true;
  options.relative = 0.01;
  options.accept = 0.02;
  const int n = 40;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Surface from(test::random_soup(seed, 40)), to(test::random_soup(seed + 50, 60));
    expect_bounds_hold(from, to, options);
    const DistanceBound bound = directed_distance_bound({from.points, from.triangles}, to.tree, options);
    std::size_t nearer = 0;
    for (std::size_t t = 0; t < from.triangles.size(); ++t) {
      double sampled = 0, longest = 0;
      for (int i = 0; i <= n; ++i) {
        for (int j = 0; i + j <= n; ++j)
          sampled = std::max(
              sampled, std::sqrt(to.tree.closest(from.at(t, 1.0 * i / n, 1.0 * j / n))->squared_distance));
      }
      for (std::size_t i = 0; i < 3; ++i)
        longest = std::max(longest, distance(from.points[from.triangles[t][i]],
                                             from.points[from.triangles[t][(i + 1) % 3]]));
      // Between two samples the distance grows by at most the distance between them.
      const double greatest = sampled + longest / n;
      EXPECT_LE(bound.triangle_upper[t], std::max(options.accept, 1.01 * greatest)) << t;
      nearer += greatest < 0.5 * bound.lower ? 1 : 0;
    }
    EXPECT_GT(nearer, 0u);
  }
}

TEST(Hausdorff, BoundsAreTightenedFromLooseOnes) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Surface from(test::random_soup(seed, 60)), to(test::random_soup(seed + 50, 40));
    HausdorffOptions options;
    options.relative = 0.01;
    const DistanceBound tight = directed_distance_bound({from.points, from.triangles}, to.tree, options);
    options.each = true;
    options.accept = 1.2 * tight.lower;
    DistanceBound bound = directed_distance_bound({from.points, from.triangles}, to.tree, options);
    EXPECT_GE(bound.upper, tight.lower);
    options.each = false;
    options.accept = 0.01 * tight.lower;
    tighten_distance_bound({from.points, from.triangles}, to.tree, options, bound);
    EXPECT_LE(bound.upper, 1.01 * bound.lower + 1e-13);
    EXPECT_LE(std::max(tight.lower, bound.lower), std::min(tight.upper, bound.upper) + 1e-13);
    // A second call changes nothing.
    const DistanceBound before = bound;
    tighten_distance_bound({from.points, from.triangles}, to.tree, options, bound);
    EXPECT_EQ(bound.triangle_upper, before.triangle_upper);
    EXPECT_EQ(bound.upper, before.upper);
  }
}

/// What bounded all distances before still does, though less accuracy is asked for than they have.
TEST(Hausdorff, BoundsAreNeverLoosened) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Surface from(test::random_soup(seed, 60)), to(test::random_soup(seed + 50, 40));
    HausdorffOptions options;
    options.relative = 0.005;
    options.each = true;
    DistanceBound bound = directed_distance_bound({from.points, from.triangles}, to.tree, options);
    const std::vector<double> before = bound.triangle_upper;
    options.relative = 0.1;
    bound.lower *= 0.5;
    tighten_distance_bound({from.points, from.triangles}, to.tree, options, bound);
    for (std::size_t t = 0; t < before.size(); ++t) EXPECT_LE(bound.triangle_upper[t], before[t]);
  }
}

TEST(Hausdorff, IsTheSameOnAnyNumberOfThreads) {
  const Surface from(test::random_soup(1, 400)), to(test::random_soup(2, 300));
  set_thread_limit(1);
  const DistanceBound one = directed_distance_bound({from.points, from.triangles}, to.tree);
  set_thread_limit(4);
  const DistanceBound four = directed_distance_bound({from.points, from.triangles}, to.tree);
  set_thread_limit(0);
  EXPECT_EQ(one.upper, four.upper);
  EXPECT_EQ(one.lower, four.lower);
  EXPECT_EQ(one.worst, four.worst);
  EXPECT_EQ(one.triangle_upper, four.triangle_upper);
}

}  // namespace
}  // namespace adamas
