#include <gtest/gtest.h>

#include <random>

#include "core/geometry/tetrahedron.h"
#include "core/geometry/triangulate.h"

namespace adamas {
namespace {

/// Returns the six tetrahedra of a box round its main diagonal.
std::vector<Tetrahedron> divided_box(const Vec3& origin, double size) {
  std::vector<Tetrahedron> result;
  for (const std::array<int, 3>& path :
       {std::array<int, 3>{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}}) {
    std::array<Vec3, 4> corners{origin, origin, origin, origin};
    for (std::size_t step = 0; step < 3; ++step) {
      for (std::size_t c = step + 1; c < 4; ++c) corners[c][path[step]] += size;
    }
    result.emplace_back(corners);
  }
  return result;
}

double clipped_area(const Tetrahedron& cell, const std::array<Vec3, 3>& t) {
  std::vector<Vec3> corners;
  for (const Weights& w : ClippedTriangle(cell, t[0], t[1], t[2])) corners.push_back(cell.point(w));
  Vec3 sum;
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += 0.5 * cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  return norm(sum);
}

class Numbers {
 public:
  double operator()() { return unit_(random_); }
  Vec3 point() { return {unit_(random_), unit_(random_), unit_(random_)}; }

 private:
  std::mt19937_64 random_{1};
  std::uniform_real_distribution<double> unit_;
};

TEST(ClippedTriangle, PartsInATilingAddUp) {
  Numbers number;
  const auto cells = divided_box({}, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const std::array<Vec3, 3> t{number.point(), number.point(), number.point()};
    double sum = 0;
    for (const Tetrahedron& cell : cells) sum += clipped_area(cell, t);
    ASSERT_NEAR(sum, 0.5 * norm(cross(t[1] - t[0], t[2] - t[0])), 1e-13);
  }
}

TEST(ClippedTriangle, HasAPartWhereTheTriangleMeetsTheCell) {
  Numbers number;
  const auto cells = divided_box({0.25, 0.25, 0.25}, 0.5);
  std::array<int, 2> seen{};
  for (int trial = 0; trial < 20000; ++trial) {
    // The triangles have all sizes, and some coordinates lie in the cells' faces.
    const double size = number();
    const auto corner = [&, middle = number.point()] {
      Vec3 p = middle + size * (number.point() - Vec3{0.5, 0.5, 0.5});
      if (number() < 0.3) p.x = 0.25;
      if (number() < 0.3) p.y = p.x;
      return p;
    };
    const std::array<Vec3, 3> t{corner(), corner(), corner()};
    for (const Tetrahedron& cell : cells) {
      const bool met = meets(cell, t[0], t[1], t[2]);
      ASSERT_EQ(met, !ClippedTriangle(cell, t[0], t[1], t[2]).empty());
      ++seen[met ? 1 : 0];
    }
  }
  EXPECT_GT(std::min(seen[0], seen[1]), 5000);
}

/// This holds also where coordinates are so great compared with the cell that a face is known to a few digits
/// only.
TEST(ClippedTriangle, OneInAFaceLiesInBothCells) {
  Numbers number;
  for (const auto& [where, size] : {std::pair(0.0, 1.0), {16.0, 1e-3}, {100.0, 0.017}, {1e4, 1.0}}) {
    const auto cells = divided_box({where, 0.3 * where, -where}, size);
    const Tetrahedron &a = cells[0], &b = cells[3];  // share the face of corners 0, 1, 3
    for (int trial = 0; trial < 1000; ++trial) {
      std::array<Vec3, 3> t;
      for (Vec3& p : t) {
        const double u = number(), v = number() * (1 - u);
        p = a.corners[0] + u * (a.corners[1] - a.corners[0]) + v * (a.corners[3] - a.corners[0]);
      }
      const double area = 0.5 * norm(cross(t[1] - t[0], t[2] - t[0]));
      ASSERT_NEAR(clipped_area(a, t), area, 1e-6 * size * size) << where;
      ASSERT_NEAR(clipped_area(b, t), area, 1e-6 * size * size) << where;
    }
  }
}

TEST(Triangulation, OfFourCornersIsTheBest) {
  Numbers number;
  for (int trial = 0; trial < 2000; ++trial) {
    // The corners lie on a circle, in order, so that the loop is convex.
    std::array<double, 4> angles{number(), number(), number(), number()};
    std::sort(angles.begin(), angles.end());
    std::vector<Vec3> points;
    for (const double a : angles) points.push_back({std::cos(6 * a), std::sin(6 * a), 0});
    const std::vector<std::uint32_t> loop{0, 1, 2, 3};
    using Triangles = std::vector<std::array<std::uint32_t, 3>>;
    const auto add_to = [](Triangles& list) {
      return [&list](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        std::array<std::uint32_t, 3> t{a, b, c};
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        list.push_back(t);
        std::sort(list.begin(), list.end());
      };
    };
    Triangles fast, best;
    triangulate_convex(points, loop, add_to(fast));
    BestTriangulation(points, loop).for_each(add_to(best));
    ASSERT_EQ(fast, best);
  }
}

}  // namespace
}  // namespace adamas
