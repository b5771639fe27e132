#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>

#include "core/base/output_file.h"
#include "core/io/multi_material_reader.h"
#include "core/io/multi_material_writer.h"
#include "sample_data.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::says;

/// Returns sample data whose fields have these names, and one value each.
MultiMaterialData with_fields(const std::vector<std::string>& names) {
  MultiMaterialData data = test::sample_data(Centering::kCells);
  data.fields.clear();
  for (const std::string& name : names) {
    data.fields.push_back({name,
                           "",
                           1,
                           std::vector<float>(data.grid.site_count(), static_cast<float>(data.fields.size())),
                           {}});
  }
  return data;
}

std::vector<std::string> names_of(const MultiMaterialData& data) {
  std::vector<std::string> names;
  for (const Field& field : data.fields) names.push_back(field.name);
  return names;
}

TEST(FieldNames, PartsWithoutTheOtherPartsKeepTheirName) {
  const test::Scratch scratch;
  const std::vector<std::string> names{"mass_z", "X Flux", "Y Flux", "x_index", "density"};
  write_multi_material_data(scratch / "a.vtr", with_fields(names));
  EXPECT_EQ(names_of(read_multi_material_data(scratch / "a.vtr")), names);
  write_multi_material_data(scratch / "b.vtr", with_fields({"p", "velocity_y", "velocity_x", "velocity_z"}));
  const MultiMaterialData vector = read_multi_material_data(scratch / "b.vtr");
  EXPECT_EQ(names_of(vector), (std::vector<std::string>{"p", "velocity"}));
  EXPECT_EQ(vector.fields[1].values[0], 2);
  EXPECT_EQ(vector.fields[1].values[1], 1);
  EXPECT_EQ(vector.fields[1].values[2], 3);
}

TEST(FieldNames, TwoOfOneNameAreRefused) {
  const test::Scratch scratch;
  write_multi_material_data(scratch / "a.vtr", with_fields({"Pressure", "other"}));
  MaterialDataOptions options;
  options.fields = {{"Pressure", "other"}};
  EXPECT_TRUE(says(error_of([&] { read_multi_material_data(scratch / "a.vtr", options); }),
                   "a.vtr: expected fields of different names, found 'Pressure' twice"));
  write_multi_material_data(scratch / "b.vtr", with_fields({"X Flow", "flow_x"}));
  EXPECT_TRUE(says(error_of([&] { read_multi_material_data(scratch / "b.vtr"); }),
                   "expected fields of different names, found 'flow_x' twice"));
}

TEST(ReaderOptions, AnArrayIsUsedOnce) {
  const test::Scratch scratch;
  write_multi_material_data(scratch / "a.vtr", with_fields({"okfield", "share"}));
  MaterialDataOptions options;
  options.fields = {{"x", "okfield"}, {"y", "okfield"}};
  EXPECT_TRUE(says(error_of([&] { read_multi_material_data(scratch / "a.vtr", options); }),
                   "field y: expected an array that is not in use, found 'okfield' used twice"));
  options.fields.clear();
  options.fractions = {{"a", "share"}, {"b", "share"}};
  EXPECT_TRUE(says(error_of([&] { read_multi_material_data(scratch / "a.vtr", options); }),
                   "fraction b: expected an array that is not in use, found 'share' used twice"));
}

TEST(ReaderOptions, MessagesNameWhatToPass) {
  const test::Scratch scratch;
  const std::string header = "NRRD0004\nsizes: 2 2 2\nencoding: text\ntype: ";
  test::put_bytes(scratch / "porous.nrrd", header + "uint8\n\n0 1 0 1 0 1 0 1\n");
  const std::string whole = error_of([&] { read_multi_material_data(scratch / "porous.nrrd"); });
  EXPECT_TRUE(says(whole, "pass --labels porous if"));
  EXPECT_TRUE(says(whole, "--fraction NAME=porous if"));
  test::put_bytes(scratch / "two words.nrrd", header + "float\n\n0 1 0 1 0 1 0 1\n");
  const std::string real = error_of([&] { read_multi_material_data(scratch / "two words.nrrd"); });
  EXPECT_TRUE(says(real, "--fraction NAME='two words', or an array of labels by --labels"));
}

/// Returns two materials on 3 x 2 x 2 cells, all of which are the first one.
MultiMaterialData two_materials() {
  MultiMaterialData data;
  data.source = "data";
  data.grid.nodes = {{{0, 1, 2, 3}, {0, 1, 2}, {0, 1, 2}}};
  data.materials = {"a", "b"};
  data.fractions = {std::vector<float>(12, 1.0f), std::vector<float>(12, 0.0f)};
  return data;
}

TEST(Fractions, BadSumsNameTheirSiteAndTheScale) {
  MultiMaterialData data = two_materials();
  data.fractions[MaterialId(0)][2 + 3 * (1 + 2 * 1)] = 0.6f;
  EXPECT_EQ(error_of([&] { data.normalise(); }),
            "data: volume fractions: expected a sum of 1 within 0.05, found 0.6 in cell (2, 1, 1)");
  data = two_materials();
  for (float& f : data.fractions[MaterialId(0)]) f = 255;
  data.grid.nodes[0].pop_back();
  data.grid.centering = Centering::kPoints;
  data.grid.nodes[1].pop_back();
  data.grid.nodes[2] = {0, 1, 2};
  for (auto& values : data.fractions) values.resize(data.grid.site_count());
  EXPECT_EQ(error_of([&] { data.normalise(); }),
            "data: volume fractions: expected a sum of 1 within 0.05, found 255 in point (0, 0, 0); values "
            "go up to "
            "255: are they scaled?");
  data = two_materials();
  data.fractions[MaterialId(1)][4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(says(error_of([&] { data.normalise(); }), "found nan in cell (1, 1, 0)"));
}

TEST(Fractions, NothingIsNoMaterialAtAnyTolerance) {
  MultiMaterialData data = two_materials();
  data.fractions[MaterialId(0)][3] = 0;
  EXPECT_TRUE(
      says(error_of([&] { data.normalise(1); }), "expected a material, found none in cell (0, 1, 0)"));
}

TEST(Fractions, RoundOffIsNothingToMend) {
  MultiMaterialData data = two_materials();
  data.fractions[MaterialId(0)][0] = 0.333333f;
  data.fractions[MaterialId(1)][0] = 0.666666f;  // as text with six digits states it
  data.fractions[MaterialId(0)][1] = 0.7f;
  data.fractions[MaterialId(1)][1] = 0.3f;
  const auto before = data.fractions;
  data.normalise();
  EXPECT_EQ(data.report.renormalised, 0u);
  EXPECT_EQ(data.fractions[MaterialId(0)][1], before[MaterialId(0)][1]);
  data.fractions[MaterialId(1)][5] = 0.001f;
  data.normalise();
  EXPECT_EQ(data.report.renormalised, 1u);
  EXPECT_NEAR(data.fractions[MaterialId(0)][5], 1 / 1.001, 1e-6);
}

TEST(Fractions, TheStepOfStoredNumbersIsKnown) {
  const test::Scratch scratch;
  const auto step_of = [&](const std::string& type, std::string_view samples, double scale) {
    std::ofstream(scratch / "a.nrrd", std::ios::binary)
        << "NRRD0004\ntype: " << type << "\ndimension: 3\nsizes: 2 2 2\nendian: little\nencoding: raw\n\n"
        << samples;
    MaterialDataOptions options;
    options.fractions = {{"water", "a.nrrd"}};
    options.rest = "air";
    options.fraction_scale = scale;
    options.centering = Centering::kCells;
    return read_multi_material_data(scratch / "a.nrrd", options).report.step;
  };
  EXPECT_DOUBLE_EQ(step_of("uint8", std::string(8, '\1'), 255), 1.0 / 255);
  EXPECT_DOUBLE_EQ(step_of("uint16", std::string(16, '\1'), 1000), 1e-3);
  EXPECT_EQ(step_of("float", std::string(32, '\0'), 1), 0);
}

TEST(Labels, AreCheckedAgainstTheMaterials) {
  MultiMaterialData data = two_materials();
  data.labels.assign(12, 1);
  EXPECT_EQ(error_of([&] { data.check(); }), "data: expected labels or volume fractions, found both");
  data.fractions.clear();
  EXPECT_NO_THROW(data.check());
  data.labels[7] = 2;
  EXPECT_EQ(error_of([&] { data.check(); }), "data: labels: expected materials below 2, found 2 at index 7");
}

TEST(Labels, WrittenOnesAreTakenWithoutBeingNamed) {
  const test::Scratch scratch;
  MultiMaterialData data = two_materials();
  data.fractions.clear();
  data.labels = std::vector<std::uint16_t>{0, 1, 0, 1, 1, 1, 0, 0, 0, 1, 1, 0};
  data.fields.push_back({"p", "", 1, std::vector<float>(12, 2.0f), {}});
  write_multi_material_data(scratch / "a.vti", data);
  const MultiMaterialData read = read_multi_material_data(scratch / "a.vti");
  EXPECT_EQ(read.labels, data.labels);
  EXPECT_EQ(read.materials, data.materials);
  EXPECT_EQ(names_of(read), std::vector<std::string>{"p"});
}

TEST(OutputFile, NamesMayBeAsLongAsTheFileSystemAllows) {
  const test::Scratch scratch;
  const std::filesystem::path name = scratch / (std::string(250, 'n') + ".json");
  OutputFile outer(name);
  {
    OutputFile inner(outer.temporary());
    EXPECT_NE(inner.temporary(), outer.temporary());
    EXPECT_EQ(inner.temporary().extension(), ".json");
    test::put_bytes(inner.temporary(), "{}");
    inner.commit();
  }
  outer.commit();
  EXPECT_EQ(test::bytes_of(name), "{}");
  EXPECT_EQ(scratch.entries(), 1);
  OutputFile odd(scratch / ("a." + std::string(240, 'e')));
  test::put_bytes(odd.temporary(), "x");
  odd.commit();
  EXPECT_EQ(scratch.entries(), 2);
}

}  // namespace
}  // namespace adamas
