#include "adamas/verify.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <random>

#include "adamas/generate.h"
#include "adamas/reconstruct.h"
#include "adamas/resample.h"
#include "core/distance/hausdorff.h"
#include "interfaces/reference_client/program_messages.h"
#include "tests/support/scratch.h"
#include "tests/support/surface_distance.h"

namespace adamas {
namespace {

using Points = std::vector<Vec3>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

class Verify : public ::testing::Test {
 protected:
  Verify() { set_reference_program(ADAMAS_REFERENCE_PROGRAM); }
  ~Verify() override { set_reference_program({}); }
};

InterfaceTriangles interfaces_of(Points points, Triangles triangles) {
  InterfaceTriangles result{std::move(points), std::move(triangles), {}, {"a", "b"}};
  result.sides.assign(result.triangles.size(), {0, 1});
  return result;
}

/// Returns a parallelogram of two triangles.
InterfaceTriangles sheet(const Vec3& corner, const Vec3& u, const Vec3& v) {
  return interfaces_of({corner, corner + u, corner + u + v, corner + v}, {{0, 1, 2}, {0, 2, 3}});
}

InterfaceTriangles together(const InterfaceTriangles& a, const InterfaceTriangles& b) {
  InterfaceTriangles result = a;
  const auto first = static_cast<std::uint32_t>(a.points.size());
  result.points.insert(result.points.end(), b.points.begin(), b.points.end());
  for (const auto& t : b.triangles) result.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  result.sides.insert(result.sides.end(), b.sides.begin(), b.sides.end());
  return result;
}

/// Returns an octahedron whose triangles are divided and whose points are moved onto a sphere.
InterfaceTriangles sphere(double radius, int divisions) {
  Points points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  Triangles triangles{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int i = 0; i < divisions; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, fresh] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
      if (fresh) points.push_back(normalized(points[a] + points[b]));
      return entry->second;
    };
    Triangles finer;
    for (const auto& [a, b, c] : triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  for (Vec3& p : points) p *= radius;
  return interfaces_of(std::move(points), std::move(triangles));
}

/// Expects that the verdict contains the distance and is as narrow as asked for.
void expect_distance(const CgalVerdict& verdict, double distance, double bound) {
  EXPECT_LE(verdict.lower, distance);
  EXPECT_GE(verdict.upper, distance);
  EXPECT_LE(verdict.upper - verdict.lower, bound + 1e-7);
}

TEST_F(Verify, ConcentricSpheres) {
  // Each point of the greater sphere lies above the same point of the smaller one, and the corners have just
  // the difference of the radii.
  for (const double bound : {0.01, 1e-3, 1e-5})
    expect_distance(verify_by_cgal(sphere(1, 3), sphere(1.1, 3), bound), 0.1, bound);
  // A fine sphere is compared with a coarse one: the middles of the coarse triangles are farthest from it.
  const InterfaceTriangles coarse = sphere(1, 1);
  double least = 1;
  for (const auto& [a, b, c] : coarse.triangles) {
    const Vec3 &p = coarse.points[a], n = cross(coarse.points[b] - p, coarse.points[c] - p);
    least = std::min(least, std::abs(dot(normalized(n), p)));
  }
  const CgalVerdict verdict = verify_by_cgal(coarse, sphere(1, 5), 1e-4);
  EXPECT_NEAR(verdict.upper, 1 - least, 2e-3);
}

TEST_F(Verify, ShiftedPlanes) {
  const InterfaceTriangles plane = sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  expect_distance(verify_by_cgal(plane, sheet({0, 0, 0.25}, {1, 0, 0}, {0, 1, 0}), 1e-4), 0.25, 1e-4);
  const InterfaceTriangles aside = sheet({0.5, 0, 0.25}, {1, 0, 0}, {0, 1, 0});
  expect_distance(verify_by_cgal(plane, aside, 1e-4), std::hypot(0.25, 0.5), 1e-4);
  // Points beyond a domain need not be near the other surface, but the nearest point of a point inside may
  // lie beyond.
  VerifyOptions options;
  options.domain = Box3{{0.5, 0, -1}, {1, 1, 1}};
  expect_distance(verify_by_cgal(plane, aside, 1e-4, options), 0.25, 1e-4);
  options.domain = Box3{{0.25, 0, -1}, {1, 1, 1}};
  expect_distance(verify_by_cgal(plane, aside, 1e-4, options), std::hypot(0.25, 0.25), 1e-4);
}

/// The middle of a sheet is farthest from the two sheets at its ends, although no corner is far from them.
/// Both sets have edges of three triangles.
TEST_F(Verify, FindsWhatNoCornerTells) {
  const InterfaceTriangles ends =
      together(sheet({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}), sheet({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}));
  const InterfaceTriangles all = together(ends, sheet({-1, 0, -1}, {2, 0, 0}, {0, 0, 2}));
  for (const double bound : {0.1, 1e-3}) {
    expect_distance(verify_by_cgal(all, ends, bound), 1, bound);
    expect_distance(verify_by_cgal(ends, all, bound), 1, bound);
  }
}

/// The greatest distance is at the one vertex of many that was moved.
TEST_F(Verify, FindsTheOnePointThatWasMoved) {
  const InterfaceTriangles plain = sphere(1, 4);
  for (const std::size_t moved : {std::size_t{0}, plain.points.size() / 2, plain.points.size() - 1}) {
    InterfaceTriangles other = plain;
    other.points[moved] *= 1.02;
    expect_distance(verify_by_cgal(plain, other, 1e-5), 0.02, 1e-5);
  }
  expect_distance(verify_by_cgal(plain, plain, 1e-5), 0, 1e-5);
}

/// The triangles have all shapes, some are flat or have two equal corners or three, and the box cuts them.
TEST_F(Verify, AgreesWithOtherMeansOnAnyTriangles) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    std::mt19937_64 random(seed);
    const auto uniform = [&random] { return std::uniform_real_distribution<double>(0, 1)(random); };
    const auto any = [&] {
      InterfaceTriangles result;
      for (int t = 0; t < 12; ++t) {
        const auto first = static_cast<std::uint32_t>(result.points.size());
        Vec3 a{uniform(), uniform(), uniform()}, b{uniform(), uniform(), uniform()},
            c{uniform(), uniform(), uniform()};
        if (t % 4 == 1) c = a + uniform() * (b - a);
        if (t % 4 == 2) c = 0.5 * (a + b) + Vec3{0, 0, std::pow(10, -14 * uniform())};
        if (t % 12 == 3) c = b;
        if (t % 12 == 7) b = c = a;
        result.points.insert(result.points.end(), {a, b, c});
        result.triangles.push_back({first, first + 1, first + 2});
      }
      result.sides.assign(result.triangles.size(), {0, 1});
      return result;
    };
    const InterfaceTriangles a = any(), b = any();
    const Box3 box{{0.2, 0.1, 0}, {0.9, 1, 0.8}};
    VerifyOptions options;
    options.domain = box;
    const CgalVerdict verdict = verify_by_cgal(a, b, 1e-3, options);
    EXPECT_LE(verdict.upper - verdict.lower, 1e-3 + 1e-7);
    EXPECT_GE(verdict.upper,
              test::sampled_distance(a.points, a.triangles, b.points, b.triangles, box, 2000, seed));
    HausdorffOptions ours;
    ours.domain = box;
    ours.relative = 1e-4;
    double upper = 0, lower = 0;
    for (const auto& [from, to] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
      const DistanceBound bound = directed_distance_bound({from->points, from->triangles},
                                                          ClosestPointTree(to->points, to->triangles), ours);
      upper = std::max(upper, bound.upper), lower = std::max(lower, bound.lower);
    }
    EXPECT_LE(verdict.lower, upper) << seed;
    EXPECT_GE(verdict.upper, lower) << seed;
  }
}

TEST_F(Verify, AgreesWithTheCertificate) {
  const GeneratedScene scene = generate_scene("tjunction", {12, 12, 12});
  ResampleOptions options;
  options.interface_error = 0.03;
  const AdaptiveMesh mesh = resample(scene.data.view(), options);
  VerifyOptions verify;
  verify.domain = Box3{{0, 0, 0}, {1, 1, 1}};
  const CgalVerdict verdict =
      verify_by_cgal(reconstruct(scene.data.view()).mesh, mesh.interfaces(), 3e-4, verify);
  const auto& ours = mesh.report().interface_error;
  ASSERT_TRUE(ours);
  EXPECT_GT(ours->certified, 0);
  EXPECT_LE(verdict.lower, ours->certified);
  EXPECT_GE(verdict.upper, ours->found);
}

TEST(CgalVerdict, ContradictsWhatCannotHoldBesideIt) {
  const CgalVerdict verdict{1, 2, 0};
  EXPECT_EQ(verdict.text(), "1 to 2");
  for (const auto& [found, certified] : {std::pair{1.5, 1.6}, {0.5, 3.0}, {0.5, 1.0}, {2.0, 3.0}})
    EXPECT_FALSE(verdict.contradiction(found, certified)) << found;
  EXPECT_EQ(verdict.contradiction(0.5, 0.9),
            "the interface error is 0.5 to 0.9, and by CGAL 1 to 2: they contradict each other");
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(
      verdict.contradiction(infinity, infinity),
      "the interface error is none shown to none shown, and by CGAL 1 to 2: they contradict each other");
}

TEST(ReferenceProgram, PathOfTheCallComesBeforeTheEnvironment) {
  const char* before = std::getenv("ADAMAS_REFERENCE_PROGRAM");
  const std::string kept = before == nullptr ? "" : before;
  set_reference_program("/bin/sh");
  EXPECT_EQ(find_reference_program("the test"), "/bin/sh");
  EXPECT_EQ(std::getenv("ADAMAS_REFERENCE_PROGRAM") == nullptr, before == nullptr);
  set_reference_program("/nowhere");
  EXPECT_EQ(test::error_of([] { find_reference_program("the test"); }),
            "adamas-reference: expected a program, found none at '/nowhere'");
  set_reference_program({});
  setenv("ADAMAS_REFERENCE_PROGRAM", "/bin/sh", 1);
  EXPECT_EQ(find_reference_program("the test"), "/bin/sh");
  before == nullptr ? unsetenv("ADAMAS_REFERENCE_PROGRAM")
                    : setenv("ADAMAS_REFERENCE_PROGRAM", kept.c_str(), 1);
}

TEST_F(Verify, NothingIsInfinitelyFarFromSomething) {
  const InterfaceTriangles plane = sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const double infinity = std::numeric_limits<double>::infinity();
  for (const bool first : {false, true}) {
    const CgalVerdict verdict = first ? verify_by_cgal({}, plane, 0.1) : verify_by_cgal(plane, {}, 0.1);
    EXPECT_EQ(verdict.lower, infinity);
    EXPECT_EQ(verdict.upper, infinity);
  }
  EXPECT_EQ(verify_by_cgal({}, {}, 0.1).upper, 0);
  VerifyOptions options;
  options.domain = Box3{{0, 0, 1}, {1, 1, 2}};
  EXPECT_NEAR(verify_by_cgal(plane, {}, 0.1, options).upper, 0, 1e-8);
}

TEST_F(Verify, ChecksItsInput) {
  const InterfaceTriangles plane = sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (const double bound : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(verify_by_cgal(plane, plane, bound), Error);
  InterfaceTriangles wrong = plane;
  wrong.triangles[1][2] = 4;
  EXPECT_NE(test::error_of([&] { verify_by_cgal(plane, wrong, 1); }).find("point 4"), std::string::npos);
  wrong = plane;
  wrong.points[2].y = std::numeric_limits<double>::infinity();
  EXPECT_THROW(verify_by_cgal(wrong, plane, 1), Error);
}

TEST_F(Verify, BelievesNoProgramThatFails) {
  const InterfaceTriangles plane = sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const test::Scratch scratch;
  const auto failure = [&](const std::string& script, const VerifyOptions& options = {}) {
    test::put_bytes(scratch / "program", "#!/bin/sh\n" + script + "\n");
    ::chmod((scratch / "program").c_str(), 0755);
    set_reference_program(scratch / "program");
    return test::error_of([&] { verify_by_cgal(plane, plane, 1, options); });
  };
  EXPECT_EQ(failure("exit 4"), "adamas-reference ended with status 4");
  EXPECT_EQ(failure("echo 0"), "adamas-reference gave no answer that can be read");
  VerifyOptions short_time;
  short_time.seconds = 0.2;
  EXPECT_EQ(failure("sleep 100", short_time), "adamas-reference took longer than 0.2 s");
  for (const auto& [lower, upper] :
       {std::pair{2.0, 1.0}, std::pair{-1.0, 1.0}, std::pair{0.0, std::nan("")}}) {
    const auto bytes = interfaces::encode(interfaces::DistanceReply{"", lower, upper});
    test::put_bytes(scratch / "reply", {bytes.begin(), bytes.end()});
    EXPECT_NE(failure("cat " + (scratch / "reply").string()).find("gave the distance as"), std::string::npos);
  }
  set_reference_program(scratch / "none");
  EXPECT_NE(test::error_of([&] { verify_by_cgal(plane, plane, 1); }).find("expected a program"),
            std::string::npos);
}

TEST_F(Verify, CanBeCancelled) {
  class Stop final : public Progress {
    void report(std::string_view, double) override {}
    [[nodiscard]] bool cancelled() const override { return ++calls_ > 3; }
    mutable int calls_ = 0;
  };
  const InterfaceTriangles sphere_a = sphere(1, 6), sphere_b = sphere(1.1, 6);
  Stop stop;
  EXPECT_THROW(verify_by_cgal(sphere_a, sphere_b, 1e-8, {}, stop), Cancelled);
}

}  // namespace
}  // namespace adamas
