// Tests NIfTI volumes, which are written byte by byte here.

#include <cmath>

#include "core/io/grid_file.h"
#include "tests/io/volume_files.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of_values;
using test::deflated;
using test::message_of_volume;
using test::NiftiHeader;
using test::put_bytes;
using test::read_numbers;
using test::says;
using test::Wrapping;

const std::string kBytes = "\1\2\3\4\5\6\7\10\11\12\13\14";

TEST(NiftiVolume, EveryTypeInEitherByteOrder) {
  constexpr std::int16_t kCodes[] = {256, 2, 4, 512, 8, 768, 1024, 1280, 16, 64};
  const test::Scratch scratch;
  for (const StoredType type : test::kStoredTypes) {
    visit_stored_type(type, [&]<class T>(T) {
      for (const bool big : {false, true}) {
        const auto values = test::typical_values<T>();
        const std::string bytes = bytes_of_values(values, big);
        NiftiHeader header(big);
        header.type(kCodes[static_cast<std::size_t>(type)], sizeof(T));
        put_bytes(scratch / "a.nii", header.text() + bytes);
        put_bytes(scratch / "b.nii.gz", deflated(header.text() + bytes, Wrapping::kGzip));
        put_bytes(scratch / "c.bin", header.text() + bytes);
        header.magic("ni1").put<float>(108, {4});
        put_bytes(scratch / "d.hdr", header.text());
        put_bytes(scratch / "d.img", "1234" + bytes);
        put_bytes(scratch / "e.hdr.gz", deflated(header.text(), Wrapping::kGzip));
        put_bytes(scratch / "e.img.gz", deflated("1234" + bytes, Wrapping::kGzip));
        for (const char* file : {"a.nii", "b.nii.gz", "c.bin", "d.hdr", "d.img", "e.hdr.gz", "e.img.gz"}) {
          VolumeReader reader = open_volume(scratch / file);
          EXPECT_EQ(reader.grid().dimensions, (std::array<std::uint64_t, 3>{3, 2, 2}));
          EXPECT_EQ(reader.grid().spacing, (Vec3{0.5, 2, 3}));
          EXPECT_EQ(reader.grid().type, sample_type_for(type));
          EXPECT_EQ(read_numbers(reader), test::as_doubles(values))
              << file << " " << stored_name(type) << big;
        }
      }
    });
  }
}

VolumeReader open_header(const test::Scratch& scratch, const NiftiHeader& header) {
  put_bytes(scratch / "a.nii", header.text() + kBytes);
  return open_volume(scratch / "a.nii");
}

TEST(NiftiVolume, ScaledValues) {
  const test::Scratch scratch;
  VolumeReader plain = open_header(scratch, NiftiHeader().put<float>(112, {1, 0}));
  EXPECT_EQ(plain.grid().type, SampleType::kUint8);
  VolumeReader none = open_header(scratch, NiftiHeader().put<float>(112, {std::nanf(""), std::nanf("")}));
  EXPECT_EQ(none.grid().type, SampleType::kUint8);
  VolumeReader scaled = open_header(scratch, NiftiHeader().put<float>(112, {0.5f, -3}));
  EXPECT_EQ(scaled.grid().type, SampleType::kFloat32);
  const auto numbers = read_numbers(scaled);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(numbers[i], 0.5 * static_cast<double>(i + 1) - 3);
  EXPECT_TRUE(
      says(scaled.note(), "a.nii: uint8 samples are read as float32, times 0.5 plus -3, without loss"));
}

TEST(NiftiVolume, PlacesOfTheHeader) {
  const test::Scratch scratch;
  VolumeReader flipped = open_header(scratch, NiftiHeader().put<std::int16_t>(254, {1}).put<float>(
                                                  280, {-2, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30}));
  EXPECT_EQ(flipped.grid().spacing, (Vec3{2, 3, 4}));
  EXPECT_EQ(flipped.grid().origin, (Vec3{10, 20, 30}));
  EXPECT_EQ(flipped.grid().directions, (std::array<Vec3, 3>{{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}));
  EXPECT_EQ(flipped.grid().space, "RAS");
  const std::vector<double> numbers{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  EXPECT_EQ(read_numbers(flipped), numbers);
  // The grid is turned by half a turn about z, and the last axis is mirrored.
  VolumeReader turned = open_header(scratch, NiftiHeader()
                                                 .put<float>(76, {-1, 0.5f, 2, 3})
                                                 .put<std::int16_t>(252, {1})
                                                 .put<float>(256, {0, 0, 1, 1, 2, 3}));
  EXPECT_EQ(turned.grid().spacing, (Vec3{0.5, 2, 3}));
  EXPECT_EQ(turned.grid().origin, (Vec3{1, 2, 3}));
  EXPECT_EQ(turned.grid().directions, (std::array<Vec3, 3>{{{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}}));
  EXPECT_TRUE(turned.grid().is_left_handed());
  EXPECT_EQ(read_numbers(turned), numbers);
  EXPECT_EQ(turned.note(), "");
  VolumeReader oblique = open_header(scratch, NiftiHeader().put<std::int16_t>(254, {1}).put<float>(
                                                  280, {1, 1, 0, 9, -1, 1, 0, 9, 0, 0, 1, 9}));
  EXPECT_NEAR(oblique.grid().spacing.x, std::sqrt(2), 1e-12);
  EXPECT_EQ(oblique.grid().origin, (Vec3{9, 9, 9}));
  EXPECT_LT(distance(oblique.grid().directions[0], Vec3{0.5, -0.5, 0} * std::sqrt(2)), 1e-12);
  EXPECT_LT(distance(oblique.grid().directions[1], Vec3{0.5, 0.5, 0} * std::sqrt(2)), 1e-12);
  EXPECT_EQ(oblique.note(), "");
  // With neither form only the lengths of steps are known.
  VolumeReader none = open_header(scratch, NiftiHeader());
  EXPECT_TRUE(none.grid().is_straight());
  EXPECT_EQ(none.grid().space, "");
}

/// Rotates a vector about an axis (Rodrigues).
Vec3 rotated(const Vec3& v, const Vec3& axis, double angle) {
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) +
         ((1 - std::cos(angle)) * dot(axis, v)) * axis;
}

TEST(NiftiVolume, QuaternionsAreRotations) {
  const test::Scratch scratch;
  for (const Vec3& about : {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 2, 3}, {-2, 1, 0.5}}) {
    for (const double angle : {0.0003, 0.7, 2.9}) {
      for (const float handedness : {1.0f, -1.0f, 0.0f}) {
        const Vec3 axis = normalized(about), part = std::sin(angle / 2) * axis;
        VolumeReader reader =
            open_header(scratch, NiftiHeader()
                                     .put<float>(76, {handedness, 0.5f, 2, 3})
                                     .put<std::int16_t>(252, {1})
                                     .put<float>(256, {static_cast<float>(part.x), static_cast<float>(part.y),
                                                       static_cast<float>(part.z), 7, -8, 9}));
        const VolumeGrid& grid = reader.grid();
        const Vec3 last = grid.in_space(grid.frame_box().max);
        const Vec3 steps{2 * 0.5, 1 * 2, (handedness < 0 ? -1 : 1) * 1 * 3.0};
        EXPECT_LT(distance(last, Vec3{7, -8, 9} + rotated(steps, axis, angle)), 1e-5);
        EXPECT_EQ(grid.is_left_handed(), handedness < 0);
        EXPECT_FALSE(grid.is_straight());
      }
    }
  }
  // The sform takes precedence.
  VolumeReader both = open_header(scratch, NiftiHeader()
                                               .put<std::int16_t>(252, {1, 1})
                                               .put<float>(256, {0, 0, 1, 1, 2, 3})
                                               .put<float>(280, {2, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30}));
  EXPECT_EQ(both.grid().origin, (Vec3{10, 20, 30}));
  EXPECT_TRUE(both.grid().is_straight());
}

TEST(NiftiVolume, OneOfSeveralTimes) {
  const test::Scratch scratch;
  const auto header = NiftiHeader().put<std::int16_t>(40, {4, 3, 2, 2, 3}).type(4, 2);
  std::vector<std::int16_t> values;
  for (std::int16_t i = 0; i < 36; ++i) values.push_back(i);
  const std::string bytes = header.text() + bytes_of_values(values);
  put_bytes(scratch / "a.nii", bytes);
  put_bytes(scratch / "b.nii.gz", deflated(bytes, Wrapping::kGzip));
  for (const char* name : {"a.nii", "b.nii.gz"}) {
    for (const std::uint64_t time : {0u, 1u, 2u}) {
      VolumeReader reader = open_volume(scratch / name, {"", {}, time});
      const auto numbers = read_numbers(reader);
      for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(numbers[i], static_cast<double>(12 * time + i)) << name;
    }
    EXPECT_TRUE(says(message_of_volume(scratch / name), "one time, or which of them by --time (0 to 2)"));
    EXPECT_TRUE(says(message_of_volume(scratch / name, {"", {}, 3}), "expected a time from 0 to 2, found 3"));
  }
  put_bytes(scratch / "cut.nii", bytes.substr(0, bytes.size() - 1));
  EXPECT_TRUE(says(message_of_volume(scratch / "cut.nii", {"", {}, 2}), "cut.nii: expected 24 bytes"));
  put_bytes(scratch / "one.nii", NiftiHeader().text() + kBytes);
  EXPECT_TRUE(
      says(message_of_volume(scratch / "one.nii", {"", {}, 1}), "expected a time from 0 to 0, found 1"));
  put_bytes(scratch / "n.nrrd", "NRRD0004\ntype: uchar\nencoding: raw\nsizes: 2 1 1\n\nab");
  EXPECT_TRUE(says(message_of_volume(scratch / "n.nrrd", {"", {}, 0}), "n.nrrd: expected NIfTI"));
}

TEST(NiftiVolume, TheSecondVersion) {
  const test::Scratch scratch;
  constexpr double kSlope = 0.5;
  for (const bool big : {false, true}) {
    std::string text(544, '\0');
    const auto put = [&]<class T>(std::size_t at, const std::vector<T>& values) {
      const std::string bytes = bytes_of_values(values, big);
      text.replace(at, bytes.size(), bytes);
    };
    put(0, std::vector<std::int32_t>{540});
    text.replace(4, 8, std::string("n+2\0\r\n\x1a\n", 8));
    put(12, std::vector<std::int16_t>{2, 8});
    put(16, std::vector<std::int64_t>{3, 3, 2, 2, 1, 1, 1, 1});
    put(104, std::vector<double>{1, 0.1, 2, 3});
    put(168, std::vector<std::int64_t>{544});
    put(176, std::vector<double>{kSlope, -1});
    put(348, std::vector<std::int32_t>{1});
    put(400, std::vector<double>{0, -0.1, 0, 1, 2, 0, 0, 2, 0, 0, 3, 3});
    put_bytes(scratch / "a.nii", text + kBytes);
    put_bytes(scratch / "b.nii.gz", deflated(text + kBytes, Wrapping::kGzip));
    put_bytes(scratch / "c", text + kBytes);
    for (const char* name : {"a.nii", "b.nii.gz", "c"}) {
      VolumeReader reader = open_volume(scratch / name);
      EXPECT_EQ(reader.grid().spacing, (Vec3{2, 0.1, 3})) << "double precision";
      EXPECT_EQ(reader.grid().directions, (std::array<Vec3, 3>{{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}}));
      EXPECT_EQ(reader.grid().origin, (Vec3{1, 2, 3}));
      const auto numbers = read_numbers(reader);
      for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(numbers[i], kSlope * static_cast<double>(i + 1) - 1);
    }
    test::expect_every_truncation_is_an_error(scratch / "a.nii", scratch / "a.nii", text.size() + 12, 7);
  }
}

TEST(NiftiVolume, BadHeaders) {
  const test::Scratch scratch;
  const auto message = [&](const NiftiHeader& header) {
    return test::error_of([&] { open_header(scratch, header); });
  };
  EXPECT_TRUE(
      says(message(NiftiHeader().put<std::int32_t>(0, {347})), "a.nii: expected NIfTI, found something"));
  EXPECT_TRUE(says(message(NiftiHeader().put<std::int32_t>(0, {540})),
                   "a.nii: expected a NIfTI header of 540 bytes, found 364"));
  EXPECT_TRUE(says(message(NiftiHeader().magic("xyz")), "expected NIfTI, found something else"));
  for (const std::int16_t axes : {0, 8, -1}) {
    EXPECT_TRUE(
        says(message(NiftiHeader().put<std::int16_t>(40, {axes})), "expected one to seven dimensions"));
  }
  EXPECT_TRUE(
      says(message(NiftiHeader().put<std::int16_t>(40, {3, 3, 0})), "expected positive sizes, found 0"));
  EXPECT_TRUE(says(message(NiftiHeader().put<std::int16_t>(40, {4, 3, 2, 1, 2})),
                   "expected one time, or which of them by --time (0 to 1), found 2 times"));
  EXPECT_TRUE(says(message(NiftiHeader().put<std::int16_t>(40, {5, 3, 2, 1, 1, 2})),
                   "expected one value per sample, found 2"));
  EXPECT_TRUE(says(message(NiftiHeader().type(128, 3)), "expected one value per sample, found 3"));
  EXPECT_TRUE(says(message(NiftiHeader().type(2, 2)), "expected 8 bits for samples of uint8, found 16"));
  for (const float offset : {100.0f, -1.0f, 352.5f, 1e20f, std::nanf(""), HUGE_VALF}) {
    EXPECT_TRUE(says(message(NiftiHeader().put<float>(108, {offset})), "expected samples from byte 348"));
  }
  EXPECT_TRUE(says(message(NiftiHeader().put<std::int16_t>(40, {3, 32767, 32767, 32767})),
                   "expected 35181150961663 bytes"));
  EXPECT_TRUE(says(message(NiftiHeader().put<std::int16_t>(254, {1}).put<float>(
                       280, {1, 0, 0, std::nanf(""), 0, 1, 0, 0, 0, 0, 1, 0})),
                   "expected a finite origin along x"));
  put_bytes(scratch / "b.hdr", NiftiHeader().magic("ni1").text());
  EXPECT_TRUE(says(message_of_volume(scratch / "b.hdr"), "b.img: expected a file, found none"));
}

TEST(NiftiVolume, EveryTruncationIsAnError) {
  const test::Scratch scratch;
  const std::string whole = NiftiHeader().text() + kBytes;
  put_bytes(scratch / "a.nii", whole);
  test::expect_every_truncation_is_an_error(scratch / "a.nii", scratch / "a.nii", whole.size());
  const std::string packed = deflated(whole, Wrapping::kGzip);
  put_bytes(scratch / "b.nii.gz", packed);
  test::expect_every_truncation_is_an_error(scratch / "b.nii.gz", scratch / "b.nii.gz", packed.size());
}

TEST(NiftiVolume, WhatFollowsTheSamplesIsTold) {
  const test::Scratch scratch;
  const std::vector<double> samples{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  put_bytes(scratch / "a.nii", NiftiHeader().text() + kBytes + "more");
  VolumeReader plain = open_volume(scratch / "a.nii");
  EXPECT_EQ(read_numbers(plain), samples);
  EXPECT_TRUE(says(plain.note(), "a.nii: 4 bytes behind the samples are not read"));
  EXPECT_EQ(read_grid_file(scratch / "a.nii").remark, "4 bytes behind the samples are not read");
  // If the file were unpacked to its end, the damage there would be found.
  std::string packed = deflated(NiftiHeader().text() + kBytes + std::string(1 << 22, '\0'), Wrapping::kGzip);
  packed[packed.size() - 6] = static_cast<char>(packed[packed.size() - 6] + 1);
  put_bytes(scratch / "a.nii.gz", packed);
  VolumeReader unpacked = open_volume(scratch / "a.nii.gz");
  EXPECT_EQ(read_numbers(unpacked), samples);
  EXPECT_TRUE(says(unpacked.note(), "a.nii.gz: bytes behind the samples are not read"));
  // There is no note about the times after the first.
  put_bytes(scratch / "t.nii", NiftiHeader().put<std::int16_t>(40, {4, 3, 2, 2, 2}).text() + kBytes + kBytes);
  for (const std::uint64_t time : {0u, 1u})
    EXPECT_EQ(open_volume(scratch / "t.nii", {.array = {}, .scratch_folder = {}, .time = time}).note(), "");
}

}  // namespace
}  // namespace adamas
