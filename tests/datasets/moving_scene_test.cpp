// Tests the scene that moves in time, and scenes as volumes.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "datasets/random_numbers.h"
#include "datasets/scene_sampling.h"
#include "datasets/scene_volume.h"

namespace adamas {

using namespace datasets;

namespace {

Scene moving(double time, const Box3& box = {{0, 0, 0}, {1, 1, 1}}) {
  return make_scene("moving", 0, {box, time});
}

TEST(MovingScene, VolumesAreKnownAtAnyTime) {
  for (const Box3& box : {Box3{{0, 0, 0}, {1, 1, 1}}, Box3{{-3, 2, 10}, {1, 5, 16}}}) {
    for (const double time : {0.0, 0.3, 0.65, 0.7, 0.9, 1.0}) {
      const Scene scene = moving(time, box);
      SceneIntegral integral;
      sample_scene(scene, {20, 15, 24}, {3, false}, SilentProgress::instance(), &integral);
      double total = 0;
      for (MaterialId m(0); m.value < scene.materials().size(); ++m.value) {
        EXPECT_NEAR(integral.volumes[m], scene.volume(m), 1e-4 * scene.volume(m) + 1e-12)
            << time << " " << scene.materials()[m];
        total += scene.volume(m);
      }
      EXPECT_NEAR(total, box.volume(), 1e-10);
    }
  }
}

TEST(MovingScene, DropsMeetAndTheOthersStayApart) {
  // Owners next to the same point touch there.
  const auto touching = [](double time) {
    const Scene scene = moving(time);
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    constexpr int kSteps = 60;
    for (int at = 0; at < kSteps * kSteps * kSteps; ++at) {
      const Vec3 p{(at % kSteps + 0.5) / kSteps, (at / kSteps % kSteps + 0.5) / kSteps,
                   (at / kSteps / kSteps + 0.5) / kSteps};
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 q = p;
        q[axis] += 1.0 / kSteps;
        const auto a = scene.owner(p).value, b = scene.owner(q).value;
        if (a != 0 && b != 0 && a != b) pairs.insert(std::minmax(a, b));
      }
    }
    return pairs;
  };
  EXPECT_TRUE(touching(0).empty());
  EXPECT_TRUE(touching(0.6).empty());
  const std::set<std::pair<std::uint32_t, std::uint32_t>> drops{{1, 2}};
  EXPECT_EQ(touching(0.8), drops);
  EXPECT_EQ(touching(1), drops);
}

TEST(MovingScene, NothingJumps) {
  RandomNumbers random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const double time = random.uniform(0, 0.99);
    const Scene before = moving(time), after = moving(time + 0.01);
    const Vec3 p = random.point(before.box());
    for (MaterialId m(0); m.value < before.materials().size(); ++m.value)
      EXPECT_NEAR(before.value(m, p), after.value(m, p), 0.01);
  }
}

TEST(MovingScene, TimesOutOfRangeAreRefused) {
  for (const double time : {-0.01, 1.01, std::nan("")}) {
    try {
      moving(time);
      ADD_FAILURE() << time;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("scene moving: expected a time from 0 to 1"), std::string::npos);
    }
  }
}

/// Returns the distance from a point to the nearest point of another owner, found by a search along many
/// directions.
double distance_to_surface(const Scene& scene, const Vec3& p) {
  RandomNumbers random(4);
  const bool inside = scene.owner(p).value != 0;
  double nearest = 1;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 way = random.direction();
    for (double far = 0.002; far < nearest; far += 0.002) {
      if ((scene.owner(p + far * way).value != 0) != inside) nearest = far;
    }
  }
  return inside ? nearest : -nearest;
}

TEST(SceneVolume, IsTheDistanceToTheNearestSurface) {
  const Scene scene = moving(0.4);
  const SceneVolume volume(scene, {4, 4, 4}, SampleType::kFloat32);
  RandomNumbers random(5);
  for (int i = 0; i < 12; ++i) {
    const Vec3 p = random.point(scene.box());
    EXPECT_NEAR(volume.value(p), distance_to_surface(scene, p), 0.01) << i;
  }
}

TEST(SceneVolume, SamplesAreOfTheBoxOnOneScale) {
  const Box3 box{{-3, 2, 10}, {1, 5, 16}};
  for (const double time : {0.0, 1.0}) {
    const Scene scene = moving(time, box);
    const SceneVolume exact(scene, {9, 7, 5}, SampleType::kFloat32),
        bytes(scene, {9, 7, 5}, SampleType::kUint8);
    EXPECT_EQ(exact.scale().slope(), 1);
    EXPECT_EQ(bytes.scale().slope(), 1.5 / 255);
    EXPECT_EQ(bytes.scale().intercept(), -0.75);
    EXPECT_LT(norm(exact.grid().box().max - box.max), 1e-12);
    std::vector<std::byte> floats(exact.grid().plane_bytes()), samples(bytes.grid().plane_bytes());
    for (std::uint64_t k = 0; k < 5; ++k) {
      exact.plane(k, floats);
      bytes.plane(k, samples);
      for (std::size_t at = 0; at < 63; ++at) {
        float value = 0;
        std::memcpy(&value, &floats[4 * at], 4);
        const Vec3 p{-3 + 0.5 * static_cast<double>(at % 9), 2 + 0.5 * static_cast<double>(at / 9),
                     10 + 1.5 * static_cast<double>(k)};
        EXPECT_NEAR(value, exact.value(p), 1e-6);
        const double stands_for = bytes.scale().slope() * static_cast<double>(samples[at]) - 0.75;
        EXPECT_NEAR(stands_for, std::clamp(exact.value(p), -0.75, 0.75), 0.76 / 255);
      }
    }
  }
}

TEST(SceneVolume, TheNumberOfThreadsChangesNothing) {
  const Scene scene = moving(1);
  const SceneVolume volume(scene, {30, 40, 3}, SampleType::kUint16);
  std::vector<std::vector<std::byte>> found;
  for (const unsigned threads : {1u, 3u}) {
    set_thread_limit(threads);
    found.emplace_back(volume.grid().plane_bytes());
    volume.plane(1, found.back());
  }
  set_thread_limit(0);
  EXPECT_EQ(found[0], found[1]);
}

TEST(SceneVolume, OneSampleSpansNothing) {
  const Scene scene = moving(1);
  EXPECT_THROW(SceneVolume(scene, {4, 1, 4}, SampleType::kUint8), Error);
}

}  // namespace
}  // namespace adamas
