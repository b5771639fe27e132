#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "adamas/file_summary.h"
#include "adamas/files.h"
#include "core/base/error.h"
#include "core/io/grid_file.h"
#include "core/io/multi_material_reader.h"
#include "core/io/volume_reader.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::put_bytes;
using test::says;
using test::Scratch;

// Files are written byte by byte, as parts 5 and 10 of the standard say: explicit value representations,
// little-endian.

std::string number_bytes(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>((value >> (8 * i)) & 0xff);
  return text;
}

std::string element(unsigned group, unsigned number, const std::string& kind, std::string value) {
  if (value.size() % 2 == 1) value += kind == "UI" || kind == "OB" ? '\0' : ' ';
  const bool is_long = kind == "OB" || kind == "OW" || kind == "SQ";
  return number_bytes(group, 2) + number_bytes(number, 2) + kind +
         (is_long ? std::string(2, '\0') + number_bytes(value.size(), 4) : number_bytes(value.size(), 2)) +
         value;
}

std::string item(const std::string& content) {
  return number_bytes(0xfffe, 2) + number_bytes(0xe000, 2) + number_bytes(content.size(), 4) + content;
}

std::string sequence(unsigned group, unsigned number, const std::vector<std::string>& items) {
  std::string all;
  for (const std::string& one : items) all += item(one);
  return element(group, number, "SQ", all);
}

std::string short_number(unsigned group, unsigned number, unsigned value) {
  return element(group, number, "US", number_bytes(value, 2));
}

std::string triple(const Vec3& p) { return fmt::format("{:.6g}\\{:.6g}\\{:.6g}", p.x, p.y, p.z); }

std::string file_bytes(const std::string& storage, const std::string& data) {
  const std::string meta = element(2, 2, "UI", storage) + element(2, 3, "UI", "1.2.3.4") +
                           element(2, 0x10, "UI", "1.2.840.10008.1.2.1");
  return std::string(128, '\0') + "DICM" + element(2, 0, "UL", number_bytes(meta.size(), 4)) + meta + data;
}

/// A slice of a series, of 4 x 3 pixels.
struct SliceFile {
  Vec3 origin;
  std::vector<std::int16_t> pixels;
  std::vector<std::uint32_t> wide_pixels = {};  ///< of four bytes, in place of `pixels`
  std::string series = "1.2.3", text = "head";
  double slope = 1, intercept = 0;
  Vec3 row{1, 0, 0}, column{0, 1, 0};
  unsigned columns = 4, rows = 3;

  void write(const std::filesystem::path& path) const {
    const std::string storage = "1.2.840.10008.5.1.4.1.1.2";
    std::string samples;
    for (const std::int16_t v : pixels) samples += number_bytes(static_cast<std::uint16_t>(v), 2);
    for (const std::uint32_t v : wide_pixels) samples += number_bytes(v, 4);
    const unsigned bits = wide_pixels.empty() ? 16 : 32, is_signed = wide_pixels.empty() ? 1 : 0;
    put_bytes(path, file_bytes(storage,
                               element(8, 0x16, "UI", storage) + element(8, 0x18, "UI", "1.2.3.5") +
                                   element(8, 0x60, "CS", "CT") + element(8, 0x103e, "LO", text) +
                                   element(0x20, 0xd, "UI", "1.2") + element(0x20, 0xe, "UI", series) +
                                   element(0x20, 0x32, "DS", triple(origin)) +
                                   element(0x20, 0x37, "DS", triple(row) + "\\" + triple(column)) +
                                   short_number(0x28, 2, 1) + element(0x28, 4, "CS", "MONOCHROME2") +
                                   short_number(0x28, 0x10, rows) + short_number(0x28, 0x11, columns) +
                                   element(0x28, 0x30, "DS", "0.5\\0.25") + short_number(0x28, 0x100, bits) +
                                   short_number(0x28, 0x101, bits) + short_number(0x28, 0x102, bits - 1) +
                                   short_number(0x28, 0x103, is_signed) +
                                   element(0x28, 0x1052, "DS", fmt::format("{}", intercept)) +
                                   element(0x28, 0x1053, "DS", fmt::format("{}", slope)) +
                                   element(0x7fe0, 0x10, "OW", samples)));
  }
};

/// The pixels of slice k: each of another value.
std::vector<std::int16_t> pixels_of(int k) {
  std::vector<std::int16_t> pixels;
  for (int i = 0; i < 12; ++i) pixels.push_back(static_cast<std::int16_t>(100 * k + i - 50));
  return pixels;
}

/// Writes five slices, 2 apart, whose names are in another order than their places.
void write_series(const Scratch& folder, double intercept = 0) {
  for (int k = 0; k < 5; ++k) {
    SliceFile slice{{10, 20, 30 + 2.0 * k}, pixels_of(k)};
    slice.intercept = intercept;
    slice.write(folder / fmt::format("ct/image{}", (3 * k) % 5));
  }
}

TEST(Dicom, SlicesOfAFolderAreOrderedByTheirPlaces) {
  const Scratch folder;
  std::filesystem::create_directory(folder / "ct");
  write_series(folder, -1000);
  put_bytes(folder / "ct/notes.txt", "These are notes.");
  const Volume volume = read_volume(folder / "ct");
  EXPECT_EQ(volume.grid.dimensions, (std::array<std::uint64_t, 3>{4, 3, 5}));
  EXPECT_EQ(volume.grid.type, SampleType::kInt16);
  EXPECT_EQ(volume.grid.spacing, (Vec3{0.25, 0.5, 2}));
  EXPECT_EQ(volume.grid.origin, (Vec3{10, 20, 30}));
  const auto* samples = reinterpret_cast<const std::int16_t*>(volume.samples.data());
  for (int k = 0; k < 5; ++k) {
    for (int i = 0; i < 12; ++i) EXPECT_EQ(samples[12 * k + i], 100 * k + i - 1050);
  }
  const GridFile grid = read_grid_file(folder / "ct");
  EXPECT_EQ(grid.kind, "DICOM");
  EXPECT_TRUE(says(grid.remark, "1 files of the folder are none of DICOM"));
  ASSERT_EQ(grid.arrays.size(), 1u);
  EXPECT_EQ(grid.arrays[0].name, "head");
}

TEST(Dicom, OtherOrientationsAreLaidOutAlongTheAxes) {
  const Scratch folder;
  std::filesystem::create_directory(folder / "ct");
  // Rows run along -z, columns along x, so slices lie along -y.
  for (int k = 0; k < 3; ++k) {
    SliceFile slice{{0, 5.0 - k, 0}, pixels_of(k)};
    slice.row = {0, 0, -1};
    slice.column = {1, 0, 0};
    slice.write(folder / fmt::format("ct/{}", k));
  }
  const GridFile grid = read_grid_file(folder / "ct");
  ASSERT_FALSE(grid.aslant);
  EXPECT_EQ(grid.nodes[0], (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(grid.nodes[1], (std::vector<double>{3, 4, 5}));
  EXPECT_EQ(grid.nodes[2], (std::vector<double>{-0.75, -0.5, -0.25, 0}));
  const auto& values = std::get<std::vector<std::int32_t>>(grid.arrays[0].values);
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      for (int z = 0; z < 4; ++z) {
        const int slice = 2 - y, row = x, column = 3 - z;
        EXPECT_EQ(values[static_cast<std::size_t>(x + 3 * (y + 3 * z))],
                  pixels_of(slice)[static_cast<std::size_t>(4 * row + column)]);
      }
    }
  }
}

TEST(Dicom, UnequalGapsAndScalesAreKept) {
  const Scratch folder;
  std::filesystem::create_directory(folder / "pet");
  for (const auto& [k, z] : {std::pair(0, 0.0), std::pair(1, 2.0), std::pair(2, 6.0)}) {
    SliceFile slice{{0, 0, z}, pixels_of(k)};
    slice.slope = 0.5 + k;
    slice.write(folder / fmt::format("pet/{}", k));
  }
  const GridFile grid = read_grid_file(folder / "pet");
  EXPECT_EQ(grid.nodes[2], (std::vector<double>{0, 2, 6}));
  EXPECT_TRUE(says(grid.remark, "slices are 2 to 4 apart"));
  const auto& values = std::get<std::vector<float>>(grid.arrays[0].values);
  for (int k = 0; k < 3; ++k)
    EXPECT_EQ(values[static_cast<std::size_t>(12 * k)], static_cast<float>((0.5 + k) * (100 * k - 50)));
  EXPECT_TRUE(says(error_of([&] { read_volume(folder / "pet"); }), "pet: "));
}

/// The numbers of pixels of four bytes come back, whatever scale they have: float32 would round them.
TEST(Dicom, WideNumbersAreExact) {
  struct Case {
    double slope, intercept, slope_above;  ///< the last: of slices above the first one
    std::string type;
  };
  for (const Case& c : {Case{1, 0, 1, "uint32"}, Case{2, 0, 2, "int64"}, Case{0.1, -3, 0.1, "uint32"},
                        Case{0.1, 0, 0.3, "float64"}}) {
    const Scratch folder;
    std::filesystem::create_directory(folder / "dose");
    for (unsigned k = 0; k < 3; ++k) {
      SliceFile slice{{0, 0, 2.0 * k}, {}};
      for (unsigned i = 0; i < 12; ++i) slice.wide_pixels.push_back(4294967295u - 12 * k - i);
      slice.slope = k == 0 ? c.slope : c.slope_above;
      slice.intercept = c.intercept;
      slice.write(folder / fmt::format("dose/{}", k));
    }
    const GridFile grid = read_grid_file(folder / "dose");
    const GridArray& array = grid.arrays[0];
    EXPECT_EQ(array.type, c.type);
    const std::vector<double> values = std::visit(
        [&](const auto& numbers) {
          std::vector<double> all;
          for (const auto number : numbers) all.push_back(array.value(number));
          return all;
        },
        array.values);
    // A store keeps the numbers, and the scale beside them.
    VolumeOptions options;
    options.keep_scale = true;
    const VolumeReader kept = open_volume(folder / "dose", options);
    EXPECT_EQ(stored_name(kept.source().stored), c.type);
    EXPECT_EQ(kept.grid().slope, array.slope);
    EXPECT_EQ(kept.grid().intercept, array.intercept);
    for (unsigned n = 0; n < 36; ++n) {
      const double wanted = (n < 12 ? c.slope : c.slope_above) * (4294967295.0 - n) + c.intercept;
      EXPECT_EQ(values[n], wanted) << c.type << " " << n;
    }
  }
}

TEST(Dicom, WhatIsNoVolumeIsRefusedInOneLine) {
  const Scratch folder;
  std::filesystem::create_directory(folder / "ct");
  std::filesystem::create_directory(folder / "empty");
  EXPECT_TRUE(says(error_of([&] { read_volume(folder / "empty"); }), "expected a file, found a folder"));
  SliceFile{{0, 0, 0}, pixels_of(0)}.write(folder / "ct/a");
  EXPECT_TRUE(says(error_of([&] { read_volume(folder / "ct"); }), "expected several slices, found one"));
  SliceFile second{{0, 0, 1}, pixels_of(1)};
  second.series = "1.2.4";
  second.text = "chest";
  second.write(folder / "ct/b");
  EXPECT_TRUE(
      says(error_of([&] { read_volume(folder / "ct"); }), "found 'head' (1 files), 'chest' (1 files)"));
  second.series = "1.2.3";
  second.columns = 3;
  second.rows = 4;
  second.write(folder / "ct/b");
  EXPECT_TRUE(says(error_of([&] { read_volume(folder / "ct"); }), "expected 4 x 3 pixels"));
  second = {{0, 0, 0}, pixels_of(1)};
  second.write(folder / "ct/b");
  EXPECT_TRUE(says(error_of([&] { read_volume(folder / "ct"); }), "one slice for each place"));
  second = {{0, 0, 1}, pixels_of(1)};
  second.row = {0, 1, 0};
  second.column = {-1, 0, 0};
  second.write(folder / "ct/b");
  EXPECT_TRUE(says(error_of([&] { read_volume(folder / "ct"); }), "expected the orientation of"));
}

TEST(Dicom, PixelsThatAFileLacksAreNoZeros) {
  const Scratch folder;
  std::filesystem::create_directory(folder / "ct");
  for (int k = 0; k < 2; ++k) {
    SliceFile slice{{0, 0, 1.0 * k}, pixels_of(k)};
    if (k == 1) slice.pixels.resize(5);
    slice.write(folder / fmt::format("ct/{}", k));
  }
  EXPECT_TRUE(says(error_of([&] { read_volume(folder / "ct"); }), "expected 24 bytes of pixels, found 10"));
}

TEST(Dicom, ASeriesIsChosenByItsDescription) {
  const Scratch folder;
  std::filesystem::create_directory(folder / "ct");
  for (int k = 0; k < 4; ++k) {
    SliceFile slice{{0, 0, 1.0 * (k / 2)}, pixels_of(k)};
    slice.series = k % 2 == 0 ? "1.2.3" : "1.2.4";
    slice.text = k % 2 == 0 ? "head" : "chest";
    slice.write(folder / fmt::format("ct/{}", k));
  }
  const Volume chest = read_volume(folder / "ct", "chest");
  EXPECT_EQ(reinterpret_cast<const std::int16_t*>(chest.samples.data())[12], pixels_of(3)[0]);
}

/// Writes two slices of a series into the folder ct.
void write_two(const Scratch& folder, const std::string& series, const std::string& text,
               const std::vector<std::int16_t>& pixels, double distance = 1) {
  for (int k = 0; k < 2; ++k) {
    SliceFile slice{{0, 0, distance * k}, pixels};
    slice.series = series;
    slice.text = text;
    slice.write(folder / fmt::format("ct/{}-{}", series, k));
  }
}

TEST(Dicom, MaterialsAreTakenOfTheSeriesThatAreNamed) {
  const Scratch folder;
  std::filesystem::create_directory(folder / "ct");
  std::vector<std::int16_t> rising, falling, organs;
  for (int i = 0; i < 12; ++i) {
    rising.push_back(static_cast<std::int16_t>(10 * i));
    falling.push_back(static_cast<std::int16_t>(110 - 10 * i));
    organs.push_back(static_cast<std::int16_t>(i / 6 + 3));
  }
  write_two(folder, "1.2.3", "rising part", rising);
  write_two(folder, "1.2.4", "falling part", falling);
  write_two(folder, "1.2.5", "organs", organs);
  for (const std::string name : {"organs", "1.2.5"}) {
    MaterialDataOptions options;
    options.labels = name;
    const MultiMaterialData data = read_multi_material_data(folder / "ct", options);
    EXPECT_EQ(std::vector<std::string>(data.materials.begin(), data.materials.end()),
              (std::vector<std::string>{"3", "4"}));
    for (std::size_t site = 0; site < 24; ++site) EXPECT_EQ(std::as_const(data.labels)[site], site % 12 / 6);
  }
  MaterialDataOptions options;
  options.fractions = {{"a", "rising part"}, {"b", "1.2.4"}};
  options.fraction_scale = 110;
  options.fields = {{"organ", "organs"}};
  const MultiMaterialData data = read_multi_material_data(folder / "ct", options);
  ASSERT_EQ(data.fractions.size(), 2u);
  for (std::size_t site = 0; site < 24; ++site) {
    EXPECT_FLOAT_EQ(data.fractions[MaterialId(0)][site], static_cast<float>(site % 12) / 11);
    EXPECT_FLOAT_EQ(data.fractions[MaterialId(1)][site], static_cast<float>(11 - site % 12) / 11);
  }
  ASSERT_EQ(data.fields.size(), 1u);
  EXPECT_EQ(data.fields[0].name, "organ");
  // Where none is named, the message tells how to choose.
  const auto message = [&](const MaterialDataOptions& how) {
    return error_of([&] { read_multi_material_data(folder / "ct", how); });
  };
  EXPECT_TRUE(says(message({}), "--labels or --fraction of materials), found 'rising part' (2 files)"));
  options = {};
  options.labels = "bones";
  EXPECT_TRUE(says(message(options), "found 'rising part' (2 files), 'falling part' (2 files), 'organs'"));
  write_two(folder, "1.2.4", "falling part", falling, 2);
  options = {};
  options.fractions = {{"a", "rising part"}, {"b", "falling part"}};
  EXPECT_TRUE(says(message(options), "expected series on one grid, found 'falling part' on another"));
  write_two(folder, "1.2.4", "organs", falling);
  options = {};
  options.labels = "organs";
  EXPECT_TRUE(says(message(options), "expected one series of DICOM 'organs'"));
}

TEST(Dicom, TheSeriesOfAFolderAreListed) {
  const Scratch folder;
  std::filesystem::create_directory(folder / "ct");
  const std::vector<std::int16_t> pixels = pixels_of(0);
  write_two(folder, "1.2.3", "head", pixels);
  EXPECT_EQ(folder_series(folder / "ct").size(), 1u);
  write_two(folder, "1.2.4", "chest", pixels);
  write_two(folder, "1.2.5", "chest", pixels);
  write_two(folder, "1.2.6", "", pixels);
  put_bytes(folder / "ct/notes", "no image");
  std::string names;
  for (const SeriesSummary& one : folder_series(folder / "ct")) {
    names += one.name + ";";
    EXPECT_EQ(one.files, 2u);
    // Its name is what chooses it.
    EXPECT_EQ(read_volume(folder / "ct", one.name).grid.dimensions[2], 2u);
  }
  EXPECT_EQ(names, "head;1.2.4;1.2.5;1.2.6;");
  EXPECT_TRUE(folder_series(folder / "ct/notes").empty());
  EXPECT_TRUE(folder_series(folder.folder()).empty());
}

/// A segmentation of two segments in a volume of 8 x 2 x 3 voxels; frames lie in no order.
std::string segmentation(bool fractional) {
  const std::string storage = "1.2.840.10008.5.1.4.1.1.66.4";
  std::vector<std::string> segments, frames;
  for (const auto& [number, label] : {std::pair(1u, "liver"), std::pair(2u, "tumour")})
    segments.push_back(short_number(0x62, 4, number) + element(0x62, 5, "LO", label));
  std::string pixels;
  for (const auto& [z, segment] : {std::pair(2, 1u), std::pair(0, 1u), std::pair(1, 2u), std::pair(1, 1u)}) {
    frames.push_back(sequence(0x20, 0x9113, {element(0x20, 0x32, "DS", triple({0, 0, 3.0 * z}))}) +
                     sequence(0x62, 0xa, {short_number(0x62, 0xb, segment)}));
    for (int i = 0; i < 16; ++i) {
      if (fractional) pixels += static_cast<char>(i < 8 ? 200 : 50);
    }
    // At the place that both segments have, the first one has other voxels.
    const bool shared = z == 1 && segment == 1;
    if (!fractional) pixels += shared ? std::string("\xf0\x00", 2) : std::string("\x0f\xf0", 2);
  }
  const unsigned bits = fractional ? 8 : 1;
  return file_bytes(
      storage,
      element(8, 0x16, "UI", storage) + element(8, 0x18, "UI", "1.2.3.9") + element(8, 0x60, "CS", "SEG") +
          element(0x20, 0xe, "UI", "1.2.3") + short_number(0x28, 2, 1) +
          element(0x28, 4, "CS", "MONOCHROME2") + element(0x28, 8, "IS", "4") + short_number(0x28, 0x10, 2) +
          short_number(0x28, 0x11, 8) + short_number(0x28, 0x100, bits) + short_number(0x28, 0x101, bits) +
          short_number(0x28, 0x102, bits - 1) + short_number(0x28, 0x103, 0) +
          element(0x62, 1, "CS", fractional ? "FRACTIONAL" : "BINARY") + sequence(0x62, 2, segments) +
          (fractional ? short_number(0x62, 0xe, 200) : "") +
          sequence(0x5200, 0x9229,
                   {sequence(0x20, 0x9116, {element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0")}) +
                    sequence(0x28, 0x9110,
                             {element(0x18, 0x50, "DS", "3") + element(0x28, 0x30, "DS", "0.5\\0.25")})}) +
          sequence(0x5200, 0x9230, frames) + element(0x7fe0, 0x10, "OB", pixels));
}

TEST(Dicom, SegmentationsAreLabelsWithNames) {
  const Scratch folder;
  put_bytes(folder / "seg.dcm", segmentation(false));
  const MultiMaterialData data = read_multi_material_data(folder / "seg.dcm", {}, SilentProgress::instance());
  ASSERT_EQ(data.materials.size(), 3u);
  EXPECT_EQ(data.grid.domain().size(), (Vec3{8 * 0.25, 2 * 0.5, 3 * 3}));
  EXPECT_EQ(data.materials[MaterialId(0)], "background");
  EXPECT_EQ(data.materials[MaterialId(1)], "liver");
  EXPECT_EQ(data.materials[MaterialId(2)], "tumour");
  for (std::size_t z = 0; z < 3; ++z) {
    for (std::size_t i = 0; i < 16; ++i) {
      const bool inside = i < 4 || i >= 12;
      const std::size_t expected = inside ? (z == 1 ? 2 : 1) : z == 1 && i < 8 ? 1 : 0;
      EXPECT_EQ(data.fraction(MaterialId(expected), 16 * z + i), 1.0f) << z << " " << i;
    }
  }
}

TEST(Dicom, SegmentationsOfFractionsAreFractions) {
  const Scratch folder;
  put_bytes(folder / "seg.dcm", segmentation(true));
  const GridFile grid = read_grid_file(folder / "seg.dcm");
  ASSERT_EQ(grid.arrays.size(), 2u);
  EXPECT_EQ(grid.arrays[1].name, "volume fraction tumour");
  const auto& tumour = std::get<std::vector<float>>(grid.arrays[1].values);
  EXPECT_EQ(tumour[0], 0.0f);
  EXPECT_EQ(tumour[16], 1.0f);
  EXPECT_EQ(tumour[24], 0.25f);
}

/// Reads a file and returns what the Error says that this throws; empty if there is none.
std::string answer(const std::filesystem::path& path) {
  try {
    read_grid_file(path);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Dicom, EveryTruncationAndFlipIsAnsweredInOneLine) {
  const Scratch folder;
  const std::string whole = segmentation(false);
  for (std::size_t size = 0; size < whole.size(); size += 37) {
    put_bytes(folder / "cut.dcm", whole.substr(0, size));
    const std::string message = answer(folder / "cut.dcm");
    EXPECT_TRUE(says(message, "cut.dcm: ")) << size << " " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
  for (std::size_t at = 130; at < whole.size(); at += 41) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x55);
    put_bytes(folder / "flip.dcm", flipped);
    const std::string message = answer(folder / "flip.dcm");
    EXPECT_EQ(message.find('\n'), std::string::npos);
    if (!message.empty()) {
      EXPECT_TRUE(says(message, "flip.dcm: ")) << at << " " << message;
    }
  }
}

}  // namespace
}  // namespace adamas
