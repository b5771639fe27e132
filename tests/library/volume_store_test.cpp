#include "adamas/volume_store.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "adamas/generate.h"
#include "isosurface/extraction/surface_normals.h"
#include "tests/support/volume_store.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::MemoryVolume;
using test::Scratch;

/// Returns hills whose grid has different spacings and an origin.
template <class Sample>
MemoryVolume<Sample> hills() {
  return {{45, 38, 33},
          [](LatticePoint p) { return 100 + 60 * std::sin(0.35 * p.i + 0.2 * p.k) * std::cos(0.3 * p.j); },
          {1, 0.5, 2},
          {5, -3, 2}};
}

template <class Sample>
std::span<const std::byte> bytes(const MemoryVolume<Sample>& volume) {
  return std::as_bytes(std::span(volume.samples));
}

template <class Sample>
class VolumeStoreOf : public testing::Test {
 protected:
  VolumeStoreOf() { VolumeStore::build(path(), volume.grid, bytes(volume)); }
  [[nodiscard]] std::filesystem::path path() const { return scratch / "store.adm"; }

  Scratch scratch;
  MemoryVolume<Sample> volume = hills<Sample>();
};
using SampleTypes = testing::Types<std::uint8_t, std::uint16_t, std::int16_t, float>;
TYPED_TEST_SUITE(VolumeStoreOf, SampleTypes);

TYPED_TEST(VolumeStoreOf, IsTheFileOfTheBuilder) {
  const auto other = this->scratch / "other.adm";
  test::build(other, this->volume);
  EXPECT_EQ(test::bytes_of(this->path()), test::bytes_of(other));
  EXPECT_EQ(this->scratch.entries(), 2);
}

TYPED_TEST(VolumeStoreOf, SurfacesAreThoseOfTheExtractor) {
  VolumeStore store = VolumeStore::open(this->path());
  test::OpenStore<TypeParam> wanted(this->volume);
  for (const double isovalue : {90.0, 120.0}) {
    for (const double error : {0.0, 0.7}) {
      const Isosurface found = store.isosurface({.isovalue = isovalue, .error = error, .plain = true});
      const ExtractedSurface surface = wanted.extract(isovalue, error);
      EXPECT_EQ(found.surface.points, surface.contour.points);
      EXPECT_EQ(found.surface.triangles, surface.contour.triangles);
      EXPECT_EQ(found.surface.normals, surface_normals<TypeParam>(wanted.pages(), surface.contour).normals);
      EXPECT_EQ(found.max_error, surface.max_error);
      EXPECT_LE(found.max_error, error);
      EXPECT_EQ(found.tetrahedra, surface.tetrahedra);
      EXPECT_EQ(found.damaged_pages, 0u);
      EXPECT_GT(found.surface.triangles.size(), 100u);
    }
  }
  const Isosurface joined = store.isosurface({.isovalue = 90});
  EXPECT_LT(2 * joined.surface.triangles.size(),
            store.isosurface({.isovalue = 90, .plain = true}).surface.triangles.size());
  EXPECT_EQ(joined.surface.normals.size(), joined.surface.points.size());
  const Isosurface few = store.isosurface({.isovalue = 90, .max_triangles = 500, .normals = false});
  EXPECT_LE(few.surface.triangles.size(), 500u);
  EXPECT_TRUE(few.surface.normals.empty());
}

TYPED_TEST(VolumeStoreOf, SurfacesAreCertified) {
  VolumeStore store = VolumeStore::open(this->path());
  EXPECT_FALSE(store.isosurface({.isovalue = 100, .error = 0.5}).distance);
  const Isosurface found = store.isosurface({.isovalue = 100, .error = 0.5, .certify = true});
  ASSERT_TRUE(found.distance);
  EXPECT_LE(found.distance->certified, 0.5);
  EXPECT_LE(found.distance->found, found.distance->certified);
  const Isosurface few = store.isosurface({.isovalue = 100, .max_triangles = 300, .certify = true});
  EXPECT_GT(few.distance->found, 0.1);
}

TYPED_TEST(VolumeStoreOf, SamplesComeBackBitForBit) {
  VolumeStore store = VolumeStore::open(this->path());
  const auto same = [](std::span<const TypeParam> a, const std::vector<TypeParam>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  };
  EXPECT_TRUE(same(store.restore().template as<TypeParam>(), this->volume.samples));
  // The part has every second sample: 4 to 8, 3 to 5 and 0 to 1 along the axes.
  const Volume part = store.restore({Box3{{13, 0, 2}, {21, 2, 7}}, 1});
  ASSERT_EQ(part.grid.dimensions, (test::Dimensions{5, 3, 2}));
  EXPECT_EQ(part.grid.origin, (Vec3{13, 0, 2}));
  EXPECT_EQ(part.grid.spacing, (Vec3{2, 1, 4}));
  std::vector<TypeParam> wanted;
  for (std::int32_t k = 0; k < 2; ++k)
    for (std::int32_t j = 3; j < 6; ++j)
      for (std::int32_t i = 4; i < 9; ++i) wanted.push_back(this->volume.at({2 * i, 2 * j, 2 * k}));
  EXPECT_TRUE(same(part.as<TypeParam>(), wanted));
  EXPECT_NE(
      test::error_of([&] {
        static_cast<void>(
            part.template as<std::conditional_t<std::is_same_v<TypeParam, float>, std::uint8_t, float>>());
      }),
      "");
}

TYPED_TEST(VolumeStoreOf, TellsWhatItHolds) {
  VolumeStore store = VolumeStore::open(this->path(), {.mapped = true});
  EXPECT_EQ(store.grid().dimensions, this->volume.grid.dimensions);
  EXPECT_EQ(store.grid().spacing, this->volume.grid.spacing);
  EXPECT_EQ(store.grid().origin, this->volume.grid.origin);
  EXPECT_EQ(store.file_bytes(), std::filesystem::file_size(this->path()));
  const auto [low, high] = std::minmax_element(this->volume.samples.begin(), this->volume.samples.end());
  ASSERT_TRUE(store.range());
  EXPECT_EQ((*store.range())[0], static_cast<double>(*low));
  EXPECT_EQ((*store.range())[1], static_cast<double>(*high));
  for (int lod = 0; lod < store.lods(); ++lod) EXPECT_GT(store.restore({{}, lod}).samples.size(), 0u);
  EXPECT_NE(test::error_of([&] { store.restore({{}, store.lods()}); }), "");
}

TEST(VolumeStore, AMirroredGridLiesInSpace) {
  const Scratch scratch;
  MemoryVolume<float> volume = hills<float>();
  VolumeStore::build(scratch / "straight.adm", volume.grid, bytes(volume));
  volume.grid.directions = {{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  VolumeStore::build(scratch / "mirrored.adm", volume.grid, bytes(volume));
  VolumeStore straight = VolumeStore::open(scratch / "straight.adm");
  VolumeStore mirrored = VolumeStore::open(scratch / "mirrored.adm");
  const Isosurface a = straight.isosurface({.isovalue = 100, .region = Box3{{10, 0, 10}, {30, 5, 40}}});
  const Isosurface b = mirrored.isosurface({.isovalue = 100, .region = Box3{{-20, 0, 10}, {0, 5, 40}}});
  ASSERT_EQ(a.surface.points.size(), b.surface.points.size());
  ASSERT_GT(a.surface.points.size(), 0u);
  for (std::size_t p = 0; p < a.surface.points.size(); ++p)
    EXPECT_NEAR(a.surface.points[p].x - 5, 5 - b.surface.points[p].x, 1e-9);
  // Triangles of both surfaces face values below the isovalue.
  EXPECT_EQ(a.surface.triangles[0][1], b.surface.triangles[0][2]);
}

TEST(VolumeStore, TwoOfThemWorkAtOnce) {
  const Scratch scratch;
  const Volume ball = generate_buckyball({64, 64, 64});
  const MemoryVolume<float> volume = hills<float>();
  VolumeStore::build(scratch / "ball.adm", ball.grid, ball.samples);
  VolumeStore::build(scratch / "hills.adm", volume.grid, bytes(volume));
  struct Job {
    std::filesystem::path path;
    double isovalue;
    std::vector<std::size_t> triangles{};
    std::vector<std::byte> samples{};
    void run() {
      VolumeStore store = VolumeStore::open(path, {.memory = 1 << 20});
      for (const double error : {2.0, 1.0, 0.5, 0.0})
        triangles.push_back(
            store.isosurface({.isovalue = isovalue, .error = error, .plain = true}).surface.triangles.size());
      samples = store.restore({{}, 1}).samples;
    }
  };
  // Two threads read one file, and a third thread another one.
  std::vector<Job> jobs{
      {scratch / "ball.adm", 80.5}, {scratch / "ball.adm", 80.5}, {scratch / "hills.adm", 100}};
  std::vector<Job> alone = jobs;
  for (Job& job : alone) job.run();
  std::vector<std::thread> threads;
  for (Job& job : jobs) threads.emplace_back([&job] { job.run(); });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t n = 0; n < jobs.size(); ++n) {
    EXPECT_EQ(jobs[n].triangles, alone[n].triangles);
    EXPECT_EQ(jobs[n].samples, alone[n].samples);
  }
}

TEST(VolumeStore, WhatIsWrongIsToldInALine) {
  const Scratch scratch;
  const std::filesystem::path path = scratch / "store.adm";
  const MemoryVolume<float> volume = hills<float>();
  const auto has = [&path](const std::string& message, const char* text) {
    EXPECT_TRUE(message.starts_with(path.string())) << message;
    EXPECT_NE(message.find(text), std::string::npos) << message;
  };
  has(test::error_of([&] { VolumeStore::open(path); }), "");
  has(test::error_of([&] { VolumeStore::build(path, volume.grid, bytes(volume).subspan(4)); }),
      "bytes of samples");
  VolumeGrid none = volume.grid;
  none.spacing.y = 0;
  has(test::error_of([&] { VolumeStore::build(path, none, bytes(volume)); }), "spacing");
  EXPECT_EQ(scratch.entries(), 0);

  VolumeStore::build(path, volume.grid, bytes(volume));
  VolumeStore store = VolumeStore::open(path);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto is_wrong_usage = [](const std::function<void()>& work, const char* text) {
    try {
      work();
      ADD_FAILURE() << "expected an error";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage);
      EXPECT_STREQ(error.what(), text);
    }
  };
  is_wrong_usage([&] { store.isosurface({.isovalue = kNone}); },
                 "--isovalue: expected a finite number, found 'nan'");
  is_wrong_usage([&] { store.isosurface({.isovalue = 100, .error = -1}); },
                 "--error: expected a number of at least 0, found '-1'");
  is_wrong_usage(
      [&] {
        store.isosurfaces(std::array{90.0, 100.0, 90.0}, {});
      },
      "--isovalue: expected another value each time, found 90 twice");
  has(test::error_of([&] {
        store.isosurface({.isovalue = 100, .region = Box3{{90, 0, 0}, {91, 1, 1}}});
      }),
      "expected a region in");
  has(test::error_of([&] { store.restore({Box3{{90, 0, 0}, {91, 1, 1}}}); }), "expected a region");
  // The store can be used after a failure.
  EXPECT_GT(store.isosurface({.isovalue = 100}).surface.triangles.size(), 0u);

  test::put_bytes(path, test::bytes_of(path).substr(0, 1000));
  has(test::error_of([&] { VolumeStore::open(path); }), "");
}

TEST(VolumeStore, CanBeCancelled) {
  struct Cancelling final : Progress {
    void report(std::string_view, double) override {}
    [[nodiscard]] bool cancelled() const override { return true; }
  } progress;
  const Scratch scratch;
  const MemoryVolume<float> volume = hills<float>();
  EXPECT_THROW(VolumeStore::build(scratch / "a.adm", volume.grid, bytes(volume), {}, progress), Cancelled);
  EXPECT_EQ(scratch.entries(), 0);
  VolumeStore::build(scratch / "a.adm", volume.grid, bytes(volume));
  VolumeStore store = VolumeStore::open(scratch / "a.adm");
  EXPECT_THROW(store.isosurface({.isovalue = 100}, progress), Cancelled);
  EXPECT_THROW(store.restore({}, 0, progress), Cancelled);
  EXPECT_GT(store.isosurface({.isovalue = 100}).surface.triangles.size(), 0u);
}

TEST(GradientsOfAStore, AreDirectionsAlongTheAxesOfTheGrid) {
  const Scratch scratch;
  const MemoryVolume<std::uint8_t> ramp{{20, 9, 7}, [](LatticePoint p) { return 10 * p.i; }, {1, 0.5, 2}, {}};
  VolumeStore::build(scratch / "ramp.adm", ramp.grid, bytes(ramp), {.gradients = true});
  VolumeStore store = VolumeStore::open(scratch / "ramp.adm");
  EXPECT_EQ(store.gradients().size(), ramp.grid.samples());
  const VolumePart part{.region = Box3{{3.5, 0, 0}, {8, 1, 4}}, .lod = 1};
  const std::vector<Vec3> directions = store.gradients(part);
  EXPECT_EQ(directions.size(), store.part_grid(part).samples());
  for (const Vec3& direction : directions) EXPECT_LT(distance(direction, {1, 0, 0}), 1e-9);
  EXPECT_THROW(store.gradients({}, 1), Error);
  VolumeStore::build(scratch / "plain.adm", ramp.grid, bytes(ramp));
  EXPECT_THROW(VolumeStore::open(scratch / "plain.adm").gradients(), Error);
}

}  // namespace
}  // namespace adamas
