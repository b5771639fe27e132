#include <cmath>

#include "core/io/multi_material_reader.h"
#include "core/io/multi_material_writer.h"
#include "sample_data.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::says;

void expect_equal(const MultiMaterialData& a, const MultiMaterialData& b, double tolerance) {
  ASSERT_EQ(a.materials, b.materials);
  EXPECT_EQ(a.grid.centering, b.grid.centering);
  EXPECT_EQ(a.labels, b.labels);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    ASSERT_EQ(a.grid.nodes[axis].size(), b.grid.nodes[axis].size());
    for (std::size_t i = 0; i < a.grid.nodes[axis].size(); ++i) {
      EXPECT_NEAR(a.grid.nodes[axis][i], b.grid.nodes[axis][i], tolerance);
    }
  }
  ASSERT_EQ(a.fractions.size(), b.fractions.size());
  for (MaterialId m(0); m.value < a.fractions.size(); ++m.value) {
    ASSERT_EQ(a.fractions[m].size(), b.fractions[m].size());
    for (std::size_t i = 0; i < a.fractions[m].size(); ++i) {
      EXPECT_NEAR(a.fractions[m][i], b.fractions[m][i], 1e-6f);
    }
  }
  ASSERT_EQ(a.fields.size(), b.fields.size());
  for (std::size_t f = 0; f < a.fields.size(); ++f) {
    EXPECT_EQ(a.fields[f].name, b.fields[f].name);
    EXPECT_EQ(a.fields[f].unit, b.fields[f].unit);
    EXPECT_EQ(a.fields[f].components, b.fields[f].components);
    EXPECT_EQ(a.fields[f].values, b.fields[f].values);
    EXPECT_EQ(a.fields[f].material_values, b.fields[f].material_values);
  }
}

TEST(MultiMaterialRoundTrip, RectilinearCellsAndPointsComeBack) {
  const test::Scratch scratch;
  for (const Centering centering : {Centering::kCells, Centering::kPoints}) {
    const MultiMaterialData data = test::sample_data(centering);
    write_multi_material_data(scratch / "a.vtr", data);
    expect_equal(read_multi_material_data(scratch / "a.vtr"), data, 0);
  }
}

TEST(MultiMaterialRoundTrip, ImageComesBackAndRefusesUnevenNodes) {
  const test::Scratch scratch;
  const MultiMaterialData even = test::sample_data(Centering::kCells, true);
  write_multi_material_data(scratch / "a.vti", even);
  expect_equal(read_multi_material_data(scratch / "a.vti"), even, 1e-12);
  const auto message =
      error_of([&] { write_multi_material_data(scratch / "b.vti", test::sample_data(Centering::kCells)); });
  EXPECT_TRUE(says(message, "b.vti: expected evenly spaced nodes"));
  EXPECT_EQ(scratch.entries(), 1);
}

TEST(MultiMaterialRoundTrip, FieldsOfDoubleStaySo) {
  const test::Scratch scratch;
  MultiMaterialData data = test::sample_data(Centering::kCells, true);
  std::vector<double> precise(data.grid.site_count()), beyond(precise.size());
  for (std::size_t i = 0; i < precise.size(); ++i) {
    precise[i] = 1000000001 + 0.5 * static_cast<double>(i);
    beyond[i] = 1e150 / static_cast<double>(i + 1);
  }
  data.fields[0].values = precise;
  data.fields[2].material_values[MaterialId(0)] = beyond;
  for (const char* name : {"a.vti", "a.vtr"}) {
    write_multi_material_data(scratch / name, data);
    expect_equal(read_multi_material_data(scratch / name), data, 1e-12);
  }
}

TEST(MultiMaterialRoundTrip, LabelsKeepTheirNames) {
  const test::Scratch scratch;
  MultiMaterialData data = test::sample_data(Centering::kPoints, true);
  for (std::size_t i = 0; i < data.grid.site_count(); ++i)
    data.labels.push_back(static_cast<std::uint16_t>(i % 3));
  data.fractions.clear();
  data.fields.clear();
  write_multi_material_data(scratch / "a.vti", data);
  MaterialDataOptions options;
  options.labels = "labels";
  expect_equal(read_multi_material_data(scratch / "a.vti", options), data, 1e-12);
}

TEST(MultiMaterialRoundTrip, SameDataGiveSameBytes) {
  const test::Scratch scratch;
  for (const char* name : {"a.vtr", "b.vtr"}) {
    write_multi_material_data(scratch / name, test::sample_data(Centering::kCells));
  }
  EXPECT_EQ(test::bytes_of(scratch / "a.vtr"), test::bytes_of(scratch / "b.vtr"));
}

TEST(MultiMaterialOptions, RestTakesWhatIsMissing) {
  const test::Scratch scratch;
  MultiMaterialData data = test::sample_data(Centering::kCells);
  write_multi_material_data(scratch / "a.vtr", data);
  MaterialDataOptions options;
  options.fractions = {{"plate", "Volume Fraction for Armor Plate"}};
  options.rest = "other";
  const MultiMaterialData read = read_multi_material_data(scratch / "a.vtr", options);
  ASSERT_EQ(read.materials.size(), 2u);
  for (std::size_t i = 0; i < read.grid.site_count(); ++i) {
    EXPECT_NEAR(read.fractions[MaterialId(1)][i], 1 - data.fractions[MaterialId(0)][i], 1e-6f);
  }
}

TEST(MultiMaterialOptions, ScaleDividesFractions) {
  const test::Scratch scratch;
  const MultiMaterialData data = test::sample_data(Centering::kCells);
  MultiMaterialData percent = data;
  percent.fields.clear();
  for (MaterialId m(0); m.value < 3; ++m.value) {
    SiteArray<float> values = data.fractions[m];
    for (float& v : values) v *= 100;
    percent.fields.push_back({"share " + std::to_string(m.value), "", 1, values, {}});
  }
  write_multi_material_data(scratch / "a.vtr", percent);
  MaterialDataOptions options;
  options.fractions = {{"a", "share 0"}, {"b", "share 1"}, {"c", "share 2"}};
  options.fraction_scale = 100;
  const MultiMaterialData read = read_multi_material_data(scratch / "a.vtr", options);
  for (MaterialId m(0); m.value < 3; ++m.value) {
    for (std::size_t i = 0; i < read.grid.site_count(); ++i) {
      EXPECT_NEAR(read.fractions[m][i], data.fractions[m][i], 1e-6f);
    }
  }
  options.fraction_scale = 0;
  EXPECT_TRUE(
      says(error_of([&] { read_multi_material_data(scratch / "a.vtr", options); }), "positive scale"));
}

TEST(MultiMaterialOptions, FractionsAndFieldsFromOtherFilesNeedTheSameGrid) {
  const test::Scratch scratch;
  const MultiMaterialData data = test::sample_data(Centering::kCells);
  const auto single = [&](const char* name, SiteArray<float> values, double shift) {
    MultiMaterialData one = data;
    for (double& x : one.grid.nodes[0]) x += shift;
    one.materials = {"m"};
    one.fractions = {std::move(values)};
    one.fields.clear();
    write_multi_material_data(scratch / name, one);
  };
  for (std::size_t m = 0; m < 3; ++m)
    single(("f" + std::to_string(m) + ".vtr").c_str(), data.fractions[MaterialId(m)], 0);
  single("shifted.vtr", data.fractions[MaterialId(1)], 0.01);
  MaterialDataOptions options;
  options.fractions = {{"a", "f0.vtr"}, {"b", "f1.vtr"}, {"c", (scratch / "f2.vtr").string()}};
  options.fields = {{"copy", "f1.vtr"}};
  const MultiMaterialData read = read_multi_material_data(scratch / "f0.vtr", options);
  EXPECT_EQ(read.materials, (IdVector<MaterialId, std::string>{"a", "b", "c"}));
  ASSERT_EQ(read.fields.size(), 1u) << "the main file's one array is a fraction and no field";
  EXPECT_EQ(read.fields[0].values, FieldValues(data.fractions[MaterialId(1)]));
  options.fractions[1].second = "shifted.vtr";
  EXPECT_TRUE(says(error_of([&] { read_multi_material_data(scratch / "f0.vtr", options); }),
                   "shifted.vtr: expected the grid of"));
  options.fractions[1].second = "nowhere.vtr";
  EXPECT_TRUE(says(error_of([&] { read_multi_material_data(scratch / "f0.vtr", options); }),
                   "fraction b: expected an array or a file, found neither called 'nowhere.vtr'"));
}

TEST(MultiMaterialOptions, ExtensiveFieldsBecomeDensities) {
  const test::Scratch scratch;
  const MultiMaterialData data = test::sample_data(Centering::kCells);
  write_multi_material_data(scratch / "a.vtr", data);
  MaterialDataOptions options;
  options.extensive = {"mass"};
  const MultiMaterialData read = read_multi_material_data(scratch / "a.vtr", options);
  const MaterialId m(1);
  double total = 0, expected = 0;
  for (std::size_t k = 0; k < read.grid.sites(2); ++k) {
    for (std::size_t j = 0; j < read.grid.sites(1); ++j) {
      for (std::size_t i = 0; i < read.grid.sites(0); ++i) {
        const std::size_t site = read.grid.site_index(i, j, k);
        total += read.fields[2].material_values[m][site] * static_cast<double>(read.fractions[m][site]) *
                 read.grid.site_volume(i, j, k);
        expected += data.fields[2].material_values[m][site];
      }
    }
  }
  EXPECT_NEAR(total, expected, 1e-5 * expected);
  options.extensive = {"weight"};
  EXPECT_TRUE(says(error_of([&] { read_multi_material_data(scratch / "a.vtr", options); }), "'weight'"));
}

TEST(MultiMaterialOptions, RegionKeepsTheSitesInside) {
  const test::Scratch scratch;
  for (const Centering centering : {Centering::kCells, Centering::kPoints}) {
    const MultiMaterialData data = test::sample_data(centering);
    write_multi_material_data(scratch / "a.vtr", data);
    MaterialDataOptions options;
    const auto& grid = data.grid;
    options.region = {grid.site_coordinate(0, 1),        grid.site_coordinate(0, 3),       -100, 100,
                      grid.site_coordinate(2, 2) - 1e-9, grid.site_coordinate(2, 3) + 1e-9};
    const MultiMaterialData read = read_multi_material_data(scratch / "a.vtr", options);
    EXPECT_EQ(read.grid.sites(0), 3u);
    EXPECT_EQ(read.grid.sites(1), grid.sites(1));
    EXPECT_EQ(read.grid.sites(2), 2u);
    const std::size_t here = read.grid.site_index(2, 1, 1), there = grid.site_index(3, 1, 3);
    EXPECT_EQ(read.grid.site(2, 1, 1), grid.site(3, 1, 3));
    EXPECT_NEAR(read.fractions[MaterialId(1)][here], data.fractions[MaterialId(1)][there], 1e-6f);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(read.fields[1].values[3 * here + c], data.fields[1].values[3 * there + c]);
    }
    options.region = {100, 101, -1, 1, -1, 1};
    EXPECT_TRUE(
        says(error_of([&] { read_multi_material_data(scratch / "a.vtr", options); }), "region: expected"));
  }
}

TEST(MultiMaterialOptions, WrongOptionsAreNamed) {
  const test::Scratch scratch;
  MultiMaterialData data = test::sample_data(Centering::kCells);
  write_multi_material_data(scratch / "a.vtr", data);
  MaterialDataOptions options;
  options.labels = "Pressure [Pa]";
  EXPECT_TRUE(says(error_of([&] { read_multi_material_data(scratch / "a.vtr", options); }),
                   "expected whole numbers"));
  options.labels = "Velocity [m/s]";
  EXPECT_TRUE(says(error_of([&] { read_multi_material_data(scratch / "a.vtr", options); }), "one component"));
  options.labels = "nothing";
  EXPECT_TRUE(says(error_of([&] { read_multi_material_data(scratch / "a.vtr", options); }), "'nothing'"));
  options = {};
  options.fractions = {{"a", "Pressure [Pa]"}};
  EXPECT_TRUE(says(error_of([&] { read_multi_material_data(scratch / "a.vtr", options); }), "sum of 1"));
}

TEST(MultiMaterialOptions, NonFiniteValuesAreNamed) {
  const test::Scratch scratch;
  MultiMaterialData data = test::sample_data(Centering::kCells);
  data.fields[0].values.set(5, 1);
  write_multi_material_data(scratch / "a.vtr", data);
  data.fields[0].values.set(5, std::numeric_limits<double>::quiet_NaN());
  const auto message = error_of([&] { write_multi_material_data(scratch / "b.vtr", data); });
  EXPECT_TRUE(says(message, "array 'Pressure': expected finite values"));
}

}  // namespace
}  // namespace adamas
