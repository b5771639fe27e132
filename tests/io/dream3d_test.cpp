// Tests files of DREAM.3D, which HDF5's library writes, against the numbers that they were made of.

#include <filesystem>
#include <limits>
#include <random>

#include "core/io/multi_material_reader.h"
#include "tests/io/volume_files.h"
#include "tests/support/hdf5_file.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::Hdf5File;
using test::says;

/// What a file holds, x fastest.
struct Grains {
  std::array<std::uint64_t, 3> cells{5, 4, 3};
  std::vector<std::int32_t> ids, phases;
  std::vector<float> angles;
  std::vector<std::string> names{"Unknown", "Nickel", "Iron, alpha"};

  explicit Grains(std::array<std::uint64_t, 3> size = {5, 4, 3}) : cells(size) {
    std::mt19937 random(3);
    for (std::uint64_t i = 0; i < size[0] * size[1] * size[2]; ++i) {
      ids.push_back(static_cast<std::int32_t>(random() % 7));
      phases.push_back(static_cast<std::int32_t>(1 + random() % 2));
      for (int axis = 0; axis < 3; ++axis) angles.push_back(static_cast<float>(random() % 100) / 10);
    }
  }

  void add_cells(Hdf5File& file, const std::string& group, bool packed = false) const {
    const std::vector<std::uint64_t> size{cells[2], cells[1], cells[0], 1};
    std::vector<std::uint64_t> vectors = size;
    vectors[3] = 3;
    file.add(group + "/FeatureIds", size, StoredType::kInt32, ids.data(), packed ? 1 : 0);
    file.add(group + "/Phases", size, StoredType::kInt32, phases.data());
    file.add(group + "/EulerAngles", vectors, StoredType::kFloat32, angles.data());
  }

  /// Expects the labels of one of the arrays, under the names that `name_of` has for its numbers.
  template <class NameOf>
  void expect(const std::filesystem::path& path, const std::string& array,
              const std::vector<std::int32_t>& numbers, const NameOf& name_of) const {
    MaterialDataOptions options;
    options.labels = array;
    const MultiMaterialData data = read_multi_material_data(path, options);
    ASSERT_EQ(data.labels.size(), numbers.size());
    for (std::size_t site = 0; site < numbers.size(); ++site)
      EXPECT_EQ(data.materials[MaterialId(std::as_const(data.labels)[site])], name_of(numbers[site]));
    EXPECT_EQ(data.grid.centering, Centering::kCells);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::array<double, 3> step{0.5, 0.25, 2}, origin{10, -20, 0.5};
      ASSERT_EQ(data.grid.nodes[axis].size(), cells[axis] + 1);
      for (std::size_t i = 0; i <= cells[axis]; ++i)
        EXPECT_EQ(data.grid.nodes[axis][i], origin[axis] + static_cast<double>(i) * step[axis]);
    }
    const auto field = std::ranges::find(data.fields, "EulerAngles", &Field::name);
    ASSERT_NE(field, data.fields.end());
    EXPECT_EQ(field->components, 3);
  }
};

std::string number_text(std::int32_t number) { return std::to_string(number); }

const std::string kContainer = "DataContainers/Synthetic/";

/// Adds the geometry of the older form.
void add_geometry(Hdf5File& file, const std::array<std::int64_t, 3>& cells, const std::vector<float>& spacing,
                  const std::string& container = kContainer) {
  const std::array<float, 3> origin{10, -20, 0.5};
  file.add(container + "_SIMPL_GEOMETRY/DIMENSIONS", {3}, StoredType::kInt64, cells.data());
  if (!spacing.empty())
    file.add(container + "_SIMPL_GEOMETRY/SPACING", {spacing.size()}, StoredType::kFloat32, spacing.data());
  file.add(container + "_SIMPL_GEOMETRY/ORIGIN", {3}, StoredType::kFloat32, origin.data());
}

void write_older(const std::filesystem::path& path, const Grains& grains, bool variable) {
  Hdf5File file(path);
  const auto& n = grains.cells;
  add_geometry(
      file,
      {static_cast<std::int64_t>(n[0]), static_cast<std::int64_t>(n[1]), static_cast<std::int64_t>(n[2])},
      {0.5f, 0.25f, 2});
  grains.add_cells(file, kContainer + "CellData", variable);
  const std::vector<std::int32_t> of_features{0, 1, 2, 1, 2, 1, 2};
  file.add(kContainer + "CellFeatureData/Phases", {7, 1}, StoredType::kInt32, of_features.data());
  file.add_texts(kContainer + "CellEnsembleData/PhaseName", grains.names, variable);
}

TEST(Dream3d, OlderFilesAreReadWithTheirGrainsAndPhases) {
  const test::Scratch scratch;
  for (const bool variable : {false, true}) {
    for (const auto& cells :
         {std::array<std::uint64_t, 3>{5, 4, 3}, {5, 5, 1}, {1, 1, 1}, {3, 3, 3}, {1, 4, 4}}) {
      const Grains grains(cells);
      const auto path = scratch / "a.dream3d";
      write_older(path, grains, variable);
      grains.expect(path, "FeatureIds", grains.ids, number_text);
      grains.expect(path, "Phases", grains.phases,
                    [&](std::int32_t phase) { return grains.names[static_cast<std::size_t>(phase)]; });
    }
  }
}

TEST(Dream3d, FilesOfSimplnxAreReadAlike) {
  const test::Scratch scratch;
  const Grains grains;
  const std::string image = "DataStructure/DataContainer/Image";
  {
    Hdf5File file(scratch / "b.dream3d");
    grains.add_cells(file, image + "/Cell Data");
    file.add_numbers(image, "_DIMENSIONS", {5, 4, 3});
    file.add_numbers(image, "_SPACING", {0.5, 0.25, 2});
    file.add_numbers(image, "_ORIGIN", {10, -20, 0.5});
    file.add_texts(image + "/Cell Ensemble Data/PhaseName", grains.names, true);
  }
  grains.expect(scratch / "b.dream3d", "FeatureIds", grains.ids, number_text);
  grains.expect(scratch / "b.dream3d", "Phases", grains.phases,
                [&](std::int32_t phase) { return grains.names[static_cast<std::size_t>(phase)]; });
}

TEST(Dream3d, WithoutLabelsOneLineTellsWhatToType) {
  const test::Scratch scratch;
  write_older(scratch / "a.dream3d", Grains(), true);
  EXPECT_TRUE(says(error_of([&] { read_multi_material_data(scratch / "a.dream3d"); }),
                   "pass --labels FeatureIds if the values"));
}

TEST(Dream3d, OfSeveralGeometriesTheFirstWithArraysIsReadAndANoteTells) {
  const test::Scratch scratch;
  const Grains grains;
  {
    Hdf5File file(scratch / "c.dream3d");
    add_geometry(file, {9, 9, 9}, {1, 1, 1}, "DataContainers/Empty/");
    add_geometry(file, {5, 4, 3}, {0.5f, 0.25f, 2});
    grains.add_cells(file, kContainer + "CellData");
  }
  grains.expect(scratch / "c.dream3d", "FeatureIds", grains.ids, number_text);
  // Without names of phases, numbers are the names.
  grains.expect(scratch / "c.dream3d", "Phases", grains.phases, number_text);
  EXPECT_TRUE(says(read_grid_file(scratch / "c.dream3d").remark, "the first of 2 image geometries"));
}

TEST(Dream3d, DamagedFilesAreRefusedInOneLine) {
  const test::Scratch scratch;
  const auto path = scratch / "d.dream3d";
  const Grains grains;
  const auto message = [&](const std::array<std::int64_t, 3>& cells, const std::vector<float>& spacing) {
    {
      Hdf5File file(path);
      add_geometry(file, cells, spacing);
      grains.add_cells(file, kContainer + "CellData");
    }
    return error_of([&] { read_grid_file(path); });
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(says(message({5, 0, 3}, {1, 1, 1}), "expected three positive numbers of cells"));
  EXPECT_TRUE(says(message({5, -4, 3}, {1, 1, 1}), "expected three positive numbers of cells"));
  EXPECT_TRUE(says(message({5, 4, 3}, {1, nan, 1}), "expected three positive spacings"));
  EXPECT_TRUE(says(message({5, 4, 3}, {1, 1}), "expected three positive spacings"));
  EXPECT_TRUE(says(message({5, 4, 3}, {}), "expected three positive spacings"));
  EXPECT_TRUE(says(message({1 << 29, 1 << 29, 1 << 29}, {1, 1, 1}), "found none"));
  write_older(path, grains, true);
  EXPECT_EQ(read_grid_file(path).arrays.size(), 3u);
  {
    Hdf5File file(path);
    file.add_group(kContainer + "_SIMPL_GEOMETRY");
  }
  EXPECT_TRUE(says(error_of([&] { read_grid_file(path); }), "other geometries: 'DataContainers/Synthetic/"));
  {
    // A header that promises what the file does not hold.
    Hdf5File file(path);
    add_geometry(file, {4096, 4096, 4096}, {1, 1, 1});
    file.add(kContainer + "CellData/FeatureIds", {4096, 4096, 4096, 1}, StoredType::kInt32, nullptr);
  }
  EXPECT_TRUE(says(error_of([&] { read_grid_file(path); }), "FeatureIds: expected"));
  test::put_bytes(path, "no HDF5");
  EXPECT_TRUE(says(error_of([&] { read_grid_file(path); }), "expected a whole HDF5 file"));
  write_older(path, grains, true);
  const std::uintmax_t size = std::filesystem::file_size(path);
  for (const std::uintmax_t part : {size / 4, size / 2, size - 40}) {
    write_older(path, grains, true);
    std::filesystem::resize_file(path, part);
    EXPECT_FALSE(error_of([&] { read_grid_file(path); }).empty()) << part;
  }
}

}  // namespace

}  // namespace adamas
