// Measures closest points: queries per second of our tree beside CGAL's AABB tree, on the same triangles and
// points, on one thread.

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <string_view>
#include <vector>

#include "core/base/parallel.h"
#include "core/distance/closest_point_tree.h"

namespace {

using adamas::Vec3;
using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using CgalTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
using Clock = std::chrono::steady_clock;

struct Soup {
  std::vector<Vec3> points;
  std::vector<adamas::ClosestPointTree::Triangle> triangles;
};

double radius(double theta, double phi) {
  return 1 + 0.05 * std::sin(9 * theta) * std::cos(7 * phi) +
         0.01 * std::sin(40 * theta) * std::sin(31 * phi);
}

Vec3 on_sphere(double theta, double phi) {
  const double r = radius(theta, phi);
  return {r * std::sin(theta) * std::cos(phi), r * std::sin(theta) * std::sin(phi), r * std::cos(theta)};
}

/// Returns a surface of about 4 n^2 triangles.
Soup bumpy_sphere(std::uint32_t n) {
  Soup soup;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j < 2 * n; ++j) {
      soup.points.push_back(on_sphere(M_PI * i / n, M_PI * j / n));
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < 2 * n; ++j) {
      const std::uint32_t a = i * 2 * n + j, b = i * 2 * n + (j + 1) % (2 * n);
      if (i > 0) soup.triangles.push_back({a, a + 2 * n, b});
      if (i + 1 < n) soup.triangles.push_back({b, a + 2 * n, b + 2 * n});
    }
  }
  return soup;
}

double seconds(Clock::time_point since) {
  return std::chrono::duration<double>(Clock::now() - since).count();
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

/// Prints the rates. Returns the number of distances that differ.
std::size_t compare(const char* name, const adamas::ClosestPointTree& ours, const CgalTree& theirs,
                    const std::vector<Vec3>& queries) {
  std::vector<double> our_rates, their_rates, ratios;
  std::size_t wrong = 0;
  for (int round = 0; round < 5; ++round) {
    std::vector<double> a(queries.size()), b(queries.size());
    auto start = Clock::now();
    for (std::size_t i = 0; i < queries.size(); ++i) a[i] = ours.closest(queries[i])->squared_distance;
    our_rates.push_back(static_cast<double>(queries.size()) / seconds(start));
    start = Clock::now();
    for (std::size_t i = 0; i < queries.size(); ++i) {
      b[i] = theirs.squared_distance({queries[i].x, queries[i].y, queries[i].z});
    }
    their_rates.push_back(static_cast<double>(queries.size()) / seconds(start));
    ratios.push_back(our_rates.back() / their_rates.back());
    wrong = 0;
    for (std::size_t i = 0; i < queries.size(); ++i)
      wrong += std::abs(std::sqrt(a[i]) - std::sqrt(b[i])) > 1e-12;
  }
  std::printf("  %-22s %10.0f %10.0f %8.2f   (%.2f to %.2f; %zu differ)\n", name, median(our_rates),
              median(their_rates), median(ratios), *std::min_element(ratios.begin(), ratios.end()),
              *std::max_element(ratios.begin(), ratios.end()), wrong);
  return wrong;
}

/// Returns the number of distances that differ.
std::size_t run(std::uint32_t n, std::size_t count) {
  const Soup soup = bumpy_sphere(n);
  auto start = Clock::now();
  const adamas::ClosestPointTree ours(soup.points, soup.triangles);
  const double our_build = seconds(start);
  Triangles triangles;
  for (const auto& t : soup.triangles) {
    const auto at = [&](int k) {
      const Vec3& p = soup.points[t[static_cast<std::size_t>(k)]];
      return Kernel::Point_3(p.x, p.y, p.z);
    };
    triangles.emplace_back(at(0), at(1), at(2));
  }
  start = Clock::now();
  CgalTree theirs(triangles.begin(), triangles.end());
  theirs.build();
  theirs.accelerate_distance_queries();
  std::printf("%zu triangles: build %.3f s, CGAL %.3f s; %.0f bytes per triangle\n", soup.triangles.size(),
              our_build, seconds(start),
              static_cast<double>(ours.memory_bytes()) / static_cast<double>(soup.triangles.size()));
  std::printf("  %-22s %10s %10s %8s\n", "queries per second", "adamas", "CGAL", "ratio");

  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3> near_surface, in_box;
  for (std::size_t i = 0; i < count; ++i) {
    const double theta = std::acos(1 - 2 * unit(random)), phi = 2 * M_PI * unit(random);
    near_surface.push_back((1 + 0.02 * (2 * unit(random) - 1)) * on_sphere(theta, phi));
    in_box.push_back({2.2 * unit(random) - 1.1, 2.2 * unit(random) - 1.1, 2.2 * unit(random) - 1.1});
  }
  std::size_t wrong = compare("near the surface", ours, theirs, near_surface);
  in_box.resize(count / 10);
  wrong += compare("anywhere in the box", ours, theirs, in_box);
  return wrong;
}

}  // namespace

/// Usage: bench_closest_point [--quick]. With --quick only the smaller surface is measured. Fails where
/// distances are not CGAL's.
int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::string_view(argv[1]) == "--quick";
  adamas::set_thread_limit(1);
  std::size_t wrong = run(71, quick ? 20000 : 100000);
  if (!quick) wrong += run(571, 100000);
  return wrong == 0 ? 0 : 1;
}
