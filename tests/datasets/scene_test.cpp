#include "datasets/scene.h"

#include <gtest/gtest.h>

#include <set>

#include "core/base/error.h"
#include "datasets/half_space_clipping.h"
#include "datasets/random_numbers.h"

namespace adamas {

using namespace datasets;

namespace {

std::vector<Scene> all_scenes() {
  std::vector<Scene> scenes;
  for (const std::string& name : scene_names()) scenes.push_back(make_scene(name, 3));
  for (std::uint64_t seed = 10; seed < 13; ++seed) scenes.push_back(make_scene("random", seed));
  return scenes;
}

/// Returns the share of points with each owner.
std::vector<double> shares(const Scene& scene, std::size_t count) {
  RandomNumbers random(77);
  std::vector<double> hits(scene.materials().size());
  for (std::size_t i = 0; i < count; ++i) hits[scene.owner(random.point(scene.box())).value] += 1;
  for (double& h : hits) h /= static_cast<double>(count);
  return hits;
}

TEST(Scene, OwnerHasTheGreatestValue) {
  for (const Scene& scene : all_scenes()) {
    RandomNumbers random(1);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = random.point(scene.box());
      const double greatest = scene.value(scene.owner(p), p);
      for (MaterialId m(0); m.value < scene.materials().size(); ++m.value) {
        EXPECT_LE(scene.value(m, p), greatest) << scene.name();
      }
    }
  }
}

TEST(Scene, FunctionRangesHoldOverBoxesAndAreReached) {
  RandomNumbers random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 corner = random.point({{0, 0, 0}, {1, 1, 1}});
    const Box3 box{corner, corner + random.uniform(0.01, 0.5) * Vec3{1, 0.7, 1.3}};
    SceneFunction f = trial % 2 == 0 ? SceneFunction::linear(random.direction(), corner, 0.1)
                                     : SceneFunction::sphere(random.point({{0, 0, 0}, {1, 1, 1}}), 0.4);
    if (trial % 3 == 0) f = f.negated();
    const FunctionRange range = f.range(box);
    double low = 1e9, high = -1e9;
    for (int i = 0; i <= 20; ++i) {
      for (int j = 0; j <= 20; ++j) {
        for (int k = 0; k <= 20; ++k) {
          const Vec3 s = box.size();
          const double v = f.value(box.min + Vec3{s.x * i / 20, s.y * j / 20, s.z * k / 20});
          low = std::min(low, v);
          high = std::max(high, v);
        }
      }
    }
    EXPECT_GE(low, range.low - 1e-12);
    EXPECT_LE(high, range.high + 1e-12);
    EXPECT_LE(low - range.low, 0.06 * norm(box.size()));
    EXPECT_LE(range.high - high, 0.06 * norm(box.size()));
  }
}

TEST(Scene, VolumesAgreeWithCountedPoints) {
  constexpr std::size_t kPoints = 200000;
  for (const Scene& scene : all_scenes()) {
    const auto counted = shares(scene, kPoints);
    double total = 0;
    for (MaterialId m(0); m.value < scene.materials().size(); ++m.value) {
      const double share = scene.volume(m) / scene.box().volume();
      const double deviation = std::sqrt(share * (1 - share) / kPoints);
      EXPECT_NEAR(counted[m.value], share, 5 * deviation + 1e-9)
          << scene.name() << " " << scene.materials()[m];
      EXPECT_LT(scene.volume_error(m), 1e-3);
      total += scene.volume(m);
    }
    EXPECT_NEAR(total, scene.box().volume(), 1e-10) << scene.name();
  }
}

TEST(Scene, VoronoiOwnerIsTheNearestSeed) {
  const Scene scene = make_scene("voronoi10", 5);
  ASSERT_EQ(scene.materials().size(), 10u);
  std::vector<Vec3> seeds;
  for (const SceneFunction& f : scene.functions()) seeds.push_back(scene.box().center() + 0.5 * f.gradient);
  RandomNumbers random(4);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = random.point(scene.box());
    std::size_t nearest = 0;
    for (std::size_t s = 1; s < seeds.size(); ++s) {
      if (distance(p, seeds[s]) < distance(p, seeds[nearest])) nearest = s;
    }
    EXPECT_EQ(scene.owner(p).value, nearest);
  }
}

TEST(Scene, ReflexRegionsHaveTheirAngles) {
  const Scene scene = make_scene("reflex");
  // The line passes through the functions' common point, along the cross product of two gradients.
  const auto& functions = scene.functions();
  const Vec3 line = normalized(cross(functions[0].gradient, functions[1].gradient));
  const Vec3 u = normalized(cross(line, {1, 0, 0})), v = cross(line, u);
  std::vector<int> degrees(3);
  for (int a = 0; a < 3600; ++a) {
    const double angle = (a + 0.5) * std::acos(-1.0) / 1800;
    const Vec3 p = functions[0].center + 0.3 * (std::cos(angle) * u + std::sin(angle) * v);
    ++degrees[scene.owner(p).value];
  }
  EXPECT_NEAR(degrees[0], 2400, 1);
  EXPECT_NEAR(degrees[1], 600, 1);
  EXPECT_NEAR(degrees[2], 600, 1);
}

TEST(Scene, TJunctionPlanesMeetInTheCentre) {
  const Scene scene = make_scene("tjunction");
  const Vec3 n{0.5, 0.5, 0}, m{0.5, 0.025, -0.375};
  RandomNumbers random(5);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = random.point(scene.box()), q = p - Vec3{0.5, 0.5, 0.5};
    const std::uint32_t expected = dot(n, q) > 0 ? 0 : dot(m, q) > 0 ? 1 : 2;
    EXPECT_EQ(scene.owner(p).value, expected);
  }
}

TEST(Scene, ScenesFollowTheirBox) {
  const Box3 box{{-3, 2, 10}, {1, 5, 16}};
  for (const std::string& name : scene_names()) {
    const Scene scene = make_scene(name, 2, {box});
    const auto counted = shares(scene, 100000);
    for (MaterialId m(0); m.value < scene.materials().size(); ++m.value) {
      EXPECT_GT(counted[m.value], 0) << name;
      EXPECT_NEAR(counted[m.value], scene.volume(m) / box.volume(), 0.008) << name;
    }
  }
}

TEST(Scene, RandomScenesDifferAndComeBack) {
  std::set<std::size_t> counts;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Scene a = make_scene("random", seed), b = make_scene("random", seed),
                c = make_scene("random", seed + 1);
    counts.insert(a.materials().size());
    EXPECT_EQ(a.functions(), b.functions());
    EXPECT_NE(a.functions(), c.functions());
    std::set<std::uint32_t> owners;
    RandomNumbers random(6);
    for (int i = 0; i < 20000; ++i) owners.insert(a.owner(random.point(a.box())).value);
    EXPECT_EQ(owners.size(), a.materials().size()) << seed;
  }
  EXPECT_EQ(counts, (std::set<std::size_t>{2, 3, 4, 5, 6}));
}

TEST(Scene, FieldsJumpBetweenMaterials) {
  const Scene scene = make_scene("voronoi10", 1);
  RandomNumbers random(8);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random.point(scene.box());
    for (const auto& [field, name] : scene_fields()) {
      for (MaterialId m(0); m.value < scene.materials().size(); ++m.value) {
        for (MaterialId other(0); other < m; ++other.value) {
          EXPECT_GT(std::abs(scene.field(field, m, p) - scene.field(field, other, p)), 4) << name;
        }
      }
    }
  }
}

TEST(Scene, BadRequestsAreRefusedInOneLine) {
  const auto message = [](auto&& call) -> std::string {
    try {
      call();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const std::string unknown = message([] { make_scene("cubes"); });
  EXPECT_NE(unknown.find("'cubes'"), std::string::npos);
  EXPECT_NE(unknown.find("tjunction"), std::string::npos);
  EXPECT_EQ(unknown.find('\n'), std::string::npos);
  EXPECT_THROW(make_scene("sphere", 0, {Box3{{0, 0, 0}, {1, 0, 1}}}), Error);
  EXPECT_THROW(make_scene("random", 0, {Box3{{0, 0, 0}, {1, std::nan(""), 1}}}), Error);
}

TEST(HalfSpaceClipping, AgreesWithCountedPointsAndComplements) {
  const Box3 box{{0, 0, 0}, {1, 2, 0.5}};
  RandomNumbers random(9);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<SceneFunction> planes;
    for (int i = 0; i < 4; ++i)
      planes.push_back(SceneFunction::linear(random.direction(), random.point(box)));
    std::size_t inside = 0;
    constexpr std::size_t kPoints = 20000;
    for (std::size_t i = 0; i < kPoints; ++i) {
      const Vec3 p = random.point(box);
      bool in = true;
      for (const SceneFunction& plane : planes) in = in && plane.value(p) >= 0;
      inside += in ? 1 : 0;
    }
    const double volume = clipped_volume(box, planes);
    EXPECT_NEAR(static_cast<double>(inside) / kPoints * box.volume(), volume, 0.02);
    auto others = planes;
    others.back() = others.back().negated();
    planes.pop_back();
    EXPECT_NEAR(volume + clipped_volume(box, others), clipped_volume(box, planes), 1e-13);
  }
}

}  // namespace
}  // namespace adamas
