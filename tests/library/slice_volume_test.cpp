#include "adamas/slice_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "adamas/files.h"
#include "adamas/generate.h"
#include "adamas/reconstruct.h"
#include "adamas/slice.h"
#include "adamas/slice_files.h"
#include "tests/library/same_slice.h"
#include "tests/support/scratch.h"

namespace adamas {

namespace {

using test::expect_same;
using test::Scratch;

/// A value that is linear in space, and a sample that changes with the step.
double value_at(const Vec3& p, std::uint32_t step) { return 2 * p.x - 3 * p.y + 0.5 * p.z + step; }

/// Samples of a linear function on a grid whose axes are turned or straight.
Volume linear_volume(bool turned, std::uint32_t step = 0) {
  Volume volume;
  volume.grid.dimensions = {9, 8, 7};
  volume.grid.type = SampleType::kFloat32;
  volume.grid.spacing = {0.25, 0.5, 0.75};
  volume.grid.origin = {1, -2, 3};
  if (turned) volume.grid.directions = {{{0.6, 0.8, 0}, {-0.8, 0.6, 0}, {0, 0, 1}}};
  std::vector<float> samples;
  for (std::uint64_t s = 0; s < volume.grid.samples(); ++s) {
    const auto i = static_cast<double>(s % 9), j = static_cast<double>(s / 9 % 8),
               k = static_cast<double>(s / 72);
    const Vec3 in_frame = volume.grid.origin + Vec3{0.25 * i, 0.5 * j, 0.75 * k};
    samples.push_back(static_cast<float>(value_at(volume.grid.in_space(in_frame), step)));
  }
  volume.samples.resize(volume.grid.bytes());
  std::memcpy(volume.samples.data(), samples.data(), volume.samples.size());
  return volume;
}

/// A plane that is aslant, and one along the axes, through the middle.
std::vector<Plane> planes_of(const Volume& volume) {
  const Vec3 middle = volume.grid.box().center();
  return {{middle, {0, 0, 1}}, {middle, normalized(Vec3{1, 2, 3})}};
}

TEST(SlicesOfAVolume, HaveItsValues) {
  for (const bool turned : {false, true}) {
    const Volume volume = linear_volume(turned);
    for (const Plane& plane : planes_of(volume)) {
      const Slice cut = slice(volume, plane);
      EXPECT_EQ(cut.field, "value");
      ASSERT_FALSE(cut.points.empty());
      ASSERT_EQ(cut.values.size(), cut.points.size());
      for (std::size_t p = 0; p < cut.points.size(); ++p) {
        EXPECT_NEAR(dot(cut.points[p] - plane.origin, plane.normal), 0, 1e-9);
        EXPECT_NEAR(cut.values[p], value_at(cut.points[p], 0), 1e-5);
      }
    }
    // The plane of equal z cuts the whole rectangle of the samples.
    EXPECT_NEAR(slice(volume, planes_of(volume)[0]).material_areas[0], 8 * 0.25 * 7 * 0.5, 1e-9);
  }
}

TEST(SlicesOfAVolume, AreThoseOfItsFile) {
  const Scratch scratch;
  for (const bool turned : {false, true}) {
    const Volume volume = linear_volume(turned);
    write_volume(scratch / "v.nrrd", volume.grid, volume.samples);
    for (const Plane& plane : planes_of(volume)) {
      const std::string file = (scratch / "v.nrrd").string();
      Slice of_file = slice({.inputs = {file}, .plane = plane});
      of_file.field = "value";
      expect_same(slice(volume, plane), of_file);
    }
  }
}

TEST(SlicesOfAStore, AreThoseOfEachStep) {
  const Scratch scratch;
  for (const bool turned : {false, true}) {
    SeriesSource series{linear_volume(turned).grid, {0, 1, 2}, {}};
    series.planes = [turned](std::uint32_t step) {
      return [volume = linear_volume(turned, step)](std::uint64_t k, std::span<std::byte> plane) {
        std::memcpy(plane.data(), volume.samples.data() + k * plane.size(), plane.size());
      };
    };
    const std::filesystem::path path = scratch / (turned ? "turned.adm" : "straight.adm");
    VolumeStore::build(path, series);
    VolumeStore store = VolumeStore::open(path);
    for (std::uint32_t step = 0; step < 3; ++step) {
      const Volume volume = linear_volume(turned, step);
      for (const Plane& plane : planes_of(volume)) {
        expect_same(slice(store, plane, step), slice(volume, plane));
        expect_same(slice(store, plane, step),
                    slice({.inputs = {path.string()}, .plane = plane, .step = step}));
      }
    }
    EXPECT_NE(
        test::error_of([&] { slice(store, planes_of(linear_volume(turned))[0], 3); }).find("less than 3"),
        std::string::npos);
    EXPECT_THROW(slice(store, {{0, 0, 1e6}, {0, 0, 1}}), Error);
  }
}

TEST(SlicesOfAVolume, CheckTheirInput) {
  Volume volume = linear_volume(false);
  EXPECT_THROW(slice(volume, {{0, 0, 1e6}, {0, 0, 1}}), Error);
  volume.samples.pop_back();
  EXPECT_NE(test::error_of([&] { slice(volume, planes_of(volume)[0]); }).find("bytes of samples"),
            std::string::npos);
}

TEST(SlicesOfAnInput, AreThoseOfItsData) {
  const GeneratedScene scene = generate_scene("sphere", {10, 10, 10});
  const Plane plane{{0.5, 0.5, 0.45}, {0, 0, 1}};
  const std::string field = scene.data.view().fields.front().name;
  const Input input(scene.data.view());
  expect_same(slice(input, plane), slice(scene.data.view(), plane));
  expect_same(slice(input, plane, {.field = field}), slice(scene.data.view(), plane, {.field = field}));
  EXPECT_THROW(slice(input, plane, {.field = "none"}), Error);
}

/// The areas of given interfaces are those of the file, and of the circle in which the plane cuts the sphere.
TEST(SlicesOfAnInput, AreThoseOfItsInterfaces) {
  const Scratch scratch;
  const GeneratedScene scene = generate_scene("sphere", {12, 12, 12});
  const GridData data = scene.data.view();
  const InterfaceTriangles given = reconstruct(data).mesh;
  const Box3 domain = data.grid.domain();
  const Plane plane{domain.center() + Vec3{0, 0, 0.013}, {0, 0, 1}};
  const Input input(given, domain);
  const Slice cut = slice(input, plane);
  EXPECT_TRUE(cut.field.empty());
  ASSERT_EQ(cut.material_areas.size(), 2u);
  EXPECT_NEAR(cut.material_areas[0] + cut.material_areas[1], domain.size().x * domain.size().y, 1e-9);
  const Slice of_data = slice(data, plane);
  for (std::size_t m = 0; m < 2; ++m) EXPECT_NEAR(cut.material_areas[m], of_data.material_areas[m], 0.02);
  EXPECT_THROW(slice(input, plane, {.field = "smooth"}), Error);
  const Input with_fields(given, domain, {}, &data);
  expect_same(slice(with_fields, plane), cut);
  expect_same(slice(with_fields, plane, {.field = "smooth"}), slice(data, plane, {.field = "smooth"}));
  write_mesh(scratch / "given.vtp", given);
  const Slice of_file = slice({.inputs = {(scratch / "given.vtp").string()}, .plane = plane});
  // The domain of the file is another one, but the sphere is the same.
  const std::size_t sphere = cut.material_areas[0] < cut.material_areas[1] ? 0 : 1;
  ASSERT_EQ(of_file.materials, cut.materials);
  EXPECT_NEAR(of_file.material_areas[sphere], cut.material_areas[sphere], 1e-9);
}

}  // namespace

}  // namespace adamas
