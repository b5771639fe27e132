// Tests segmentations of 3D Slicer in several layers against the segments of each sample, found one by one.

#include <map>
#include <random>

#include "core/io/multi_material_reader.h"
#include "tests/io/volume_files.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of_values;
using test::error_of;
using test::put_bytes;
using test::says;

constexpr std::size_t kX = 13, kY = 7, kZ = 5, kSites = kX * kY * kZ, kLayers = 3;

struct TestSegment {
  std::string name;
  std::size_t layer;
  int value;
};

const std::vector<TestSegment> kSegments{{"skin", 0, 1},     {"bone", 1, 1},  {"vessel", 0, 2},
                                         {"tumour", 2, 300}, {"nerve", 1, 2}, {"absent", 2, 9}};

std::string segment_keys(const std::vector<TestSegment>& segments) {
  std::string text;
  for (std::size_t s = 0; s < segments.size(); ++s)
    text += fmt::format("Segment{0}_Layer:={1}\nSegment{0}_Name:={2}\nSegment{0}_LabelValue:={3}\n", s,
                        segments[s].layer, segments[s].name, segments[s].value);
  return text;
}

/// Makes the numbers of layers at each site, some of which are of no segment.
std::vector<std::array<std::int16_t, kLayers>> random_layers() {
  std::mt19937 random(5);
  std::vector<std::array<std::int16_t, kLayers>> layers(kSites);
  std::array<std::int16_t, kLayers> now{};
  for (auto& site : layers) {
    if (random() % 3 == 0)
      now = {static_cast<std::int16_t>(random() % 3), static_cast<std::int16_t>(random() % 3),
             static_cast<std::int16_t>(random() % 4 == 0    ? 300
                                       : random() % 20 == 0 ? 7
                                                            : 0)};
    site = now;
  }
  return layers;
}

/// What the segments of a site are by their definition.
struct Expected {
  std::vector<std::string> names;  ///< of each site
  std::map<std::string, int> lost;
  int overlaps = 0, strangers = 0;
};

Expected expected_of(const std::vector<std::array<std::int16_t, kLayers>>& layers) {
  Expected expected;
  for (const auto& site : layers) {
    std::vector<std::string> there;
    std::size_t known = 0, numbers = 0;
    for (const TestSegment& segment : kSegments) {
      if (site[segment.layer] != segment.value) continue;
      there.push_back(segment.name);
      ++known;
    }
    for (const std::int16_t number : site) numbers += number != 0 ? 1 : 0;
    if (known < numbers) ++expected.strangers;
    if (there.size() > 1) ++expected.overlaps;
    for (std::size_t i = 0; i + 1 < there.size(); ++i) ++expected.lost[there[i]];
    expected.names.push_back(there.empty() ? "background" : there.back());
  }
  return expected;
}

std::vector<std::string> names_of_sites(const MultiMaterialData& data) {
  std::vector<std::string> names;
  for (std::size_t site = 0; site < data.labels.size(); ++site)
    names.push_back(data.materials[MaterialId(std::as_const(data.labels)[site])]);
  return names;
}

std::string swapped(std::string bytes) {
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
  return bytes;
}

TEST(SegmentLayers, TheLastSegmentHasWhatSeveralShareAndOthersAreToldToLoseIt) {
  const auto layers = random_layers();
  const Expected expected = expected_of(layers);
  ASSERT_GT(expected.overlaps, 20);
  ASSERT_GT(expected.strangers, 3);
  std::vector<std::int16_t> together, apart;
  for (const auto& site : layers) together.insert(together.end(), site.begin(), site.end());
  for (std::size_t layer = 0; layer < kLayers; ++layer)
    for (const auto& site : layers) apart.push_back(site[layer]);
  const auto header = [](const std::string& encoding, bool first) {
    return "NRRD0004\ntype: short\ndimension: 4\nsizes: " +
           (first ? std::string("3 13 7 5\nkinds: list domain domain domain")
                  : std::string("13 7 5 3\nkinds: domain domain domain list")) +
           "\nendian: big\nencoding: " + encoding + "\n" + segment_keys(kSegments) + "\n";
  };
  const auto gzip = [](const std::string& bytes) { return test::deflated(bytes, test::Wrapping::kGzip); };
  const std::string a = swapped(bytes_of_values(together)), b = swapped(bytes_of_values(apart));
  const std::map<std::string, std::string> files{{"first.seg.nrrd", header("raw", true) + a},
                                                 {"packed.seg.nrrd", header("gzip", true) + gzip(a)},
                                                 {"last.seg.nrrd", header("raw", false) + b},
                                                 {"last_packed.seg.nrrd", header("gzip", false) + gzip(b)}};
  const test::Scratch scratch;
  for (const auto& [name, bytes] : files) {
    put_bytes(scratch / name, bytes);
    std::string notes;
    MaterialDataOptions options;
    options.note = [&notes](const std::string& note) { notes += note + "\n"; };
    const MultiMaterialData data = read_multi_material_data(scratch / name, options);
    EXPECT_EQ(names_of_sites(data), expected.names) << name;
    EXPECT_TRUE(says(notes, fmt::format("segments overlap in {} voxels", expected.overlaps))) << notes;
    EXPECT_TRUE(says(notes, fmt::format("layers of {} voxels belong to no", expected.strangers))) << notes;
    for (const auto& [segment, count] : expected.lost)
      EXPECT_TRUE(says(notes, fmt::format("'{}' loses {}", segment, count))) << notes;
    EXPECT_EQ(std::ranges::find(data.materials, "absent"), data.materials.end());
    // The same numbers without runs, as summaries read them.
    const GridFile file = read_grid_file(scratch / name);
    ASSERT_EQ(file.arrays.size(), 1u);
    EXPECT_EQ(file.arrays[0].components, 1);
    const auto& numbers = std::get<std::vector<std::int32_t>>(file.arrays[0].values);
    for (std::size_t site = 0; site < kSites; ++site) {
      const auto label = static_cast<std::size_t>(numbers[site]);
      EXPECT_EQ(label == 0 ? "background" : kSegments[label - 1].name, expected.names[site]);
    }
  }
}

TEST(SegmentLayers, OfOlderFilesHaveASegmentEach) {
  const test::Scratch scratch;
  const std::string keys = "Segment0_Name:=left\nSegment1_Name:=right\n", text = "2 3 1 1\nkinds: vector ";
  put_bytes(scratch / "a.seg.nrrd", "NRRD0004\ntype: uchar\nencoding: raw\nsizes: " + text +
                                        "domain domain domain\n" + keys + "\n" +
                                        std::string("\1\0\0\1\1\1", 6));
  const MultiMaterialData data = read_multi_material_data(scratch / "a.seg.nrrd");
  EXPECT_EQ(names_of_sites(data), (std::vector<std::string>{"left", "right", "right"}));
}

TEST(SegmentLayers, AreRefusedWhereTheHeaderContradictsItself) {
  const test::Scratch scratch;
  const auto message = [&](const std::string& type, const std::string& keys, std::size_t bytes) {
    put_bytes(scratch / "a.seg.nrrd",
              "NRRD0004\ntype: " + type +
                  "\nencoding: raw\nendian: little\nsizes: 2 3 1 1\nkinds: list domain domain domain\n" +
                  keys + "\n" + std::string(bytes, '\0'));
    return error_of([&] { read_multi_material_data(scratch / "a.seg.nrrd"); });
  };
  EXPECT_TRUE(says(message("uchar", "Segment0_Name:=a\nSegment0_Layer:=2\n", 6),
                   "Segment0_Layer: expected a layer from 0 to 1, found 2"));
  EXPECT_TRUE(says(message("uchar", "Segment0_Name:=a\nSegment0_Layer:=-1\n", 6),
                   "expected a whole number of a segment, found '-1'"));
  EXPECT_TRUE(says(message("uchar", "Segment0_Name:=a\nSegment0_LabelValue:=one\n", 6),
                   "expected a whole number of a segment, found 'one'"));
  EXPECT_TRUE(says(message("uchar", "Segment0_Name:=a\nSegment1_Name:=b\nSegment0_Layer:=1\n", 6),
                   "expected Segment1_Layer beside those of other segments, found none"));
  EXPECT_TRUE(says(message("uchar", "Segment0_Name:=a\n", 6), "expected a layer for each of 1 segments"));
  EXPECT_TRUE(says(message("float", "Segment0_Name:=a\nSegment0_Layer:=1\n", 24),
                   "expected segments in layers as whole numbers, found float32"));
  EXPECT_FALSE(message("uchar", "Segment0_Name:=a\nSegment0_Layer:=1\n", 5).empty());
}

}  // namespace

}  // namespace adamas
