#include <zlib.h>

#include <cstring>
#include <random>

#include "adamas/file_summary.h"
#include "core/io/grid_file.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/multi_material_reader.h"
#include "core/io/multi_material_writer.h"
#include "core/io/unstructured_mesh_io.h"
#include "sample_data.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of;
using test::error_of;
using test::put_bytes;
using test::says;
using test::Scratch;

template <class T>
std::string raw(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

std::string gzip(const std::filesystem::path& scratch, const std::string& bytes) {
  gzFile file = gzopen(scratch.c_str(), "wb9");
  gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
  gzclose(file);
  return bytes_of(scratch);
}

/// Returns noise, so that compressed data are long too.
std::string voxels() {
  std::mt19937 random(3);
  std::string bytes;
  for (int i = 0; i < 6 * 5 * 4; ++i) bytes += raw(static_cast<std::int16_t>(random() % 2000));
  return bytes;
}

std::string nifti() {
  std::string header(352, '\0');
  const auto set = [&header](std::size_t at, const std::string& value) {
    header.replace(at, value.size(), value);
  };
  set(0, raw(std::int32_t{348}));
  const std::array<std::int16_t, 8> size{3, 6, 5, 4, 1, 1, 1, 1};
  for (std::size_t i = 0; i < 8; ++i) set(40 + 2 * i, raw(size[i]));
  set(70, raw(std::int16_t{4}) + raw(std::int16_t{16}));
  const std::array<float, 4> spacing{1, 0.5f, 0.25f, 2};
  for (std::size_t i = 0; i < 4; ++i) set(76 + 4 * i, raw(spacing[i]));
  set(108, raw(352.0f) + raw(2.0f) + raw(-10.0f));
  set(344, std::string("n+1\0", 4));
  return header + voxels();
}

std::string tiff() {
  const std::size_t page = 6 * 5 * 2;
  std::string bytes = std::string("II*\0", 4) + raw(std::uint32_t{8});
  for (std::uint32_t z = 0; z < 4; ++z) {
    const auto at = static_cast<std::uint32_t>(bytes.size());
    const std::array<std::array<std::uint32_t, 2>, 9> tags{{{256, 6},
                                                            {257, 5},
                                                            {258, 16},
                                                            {259, 1},
                                                            {262, 1},
                                                            {273, at + 2 + 9 * 12 + 4},
                                                            {277, 1},
                                                            {278, 5},
                                                            {279, page}}};
    bytes += raw(std::uint16_t{9});
    for (const auto& tag : tags) {
      bytes += raw(static_cast<std::uint16_t>(tag[0])) + raw(std::uint16_t{4}) + raw(std::uint32_t{1}) +
               raw(tag[1]);
    }
    bytes += raw(z == 3 ? std::uint32_t{0} : static_cast<std::uint32_t>(at + 2 + 9 * 12 + 4 + page));
    bytes += voxels().substr(z * page, page);
  }
  return bytes;
}

struct Sample {
  std::string name;
  std::string bytes;
  double value;  ///< value of the voxel with index 7 of the first array, as the reader gives it
};

std::vector<Sample> image_samples(const Scratch& scratch) {
  const std::string data = voxels();
  std::int16_t seventh = 0;
  std::memcpy(&seventh, data.data() + 14, 2);
  std::string swapped = data;
  for (std::size_t i = 0; i < data.size(); i += 2) std::swap(swapped[i], swapped[i + 1]);
  const std::string nrrd =
      "NRRD0004\ntype: int16\ndimension: 3\nsizes: 6 5 4\nspacings: 1 2 3\nendian: little\n";
  const std::string meta =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "DimSize = 6 5 4\nElementSpacing = 1 2 3\nElementType = MET_SHORT\n";
  const std::string legacy =
      "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 6 5 4\n"
      "SPACING 1 2 3\nORIGIN 0 0 0\nPOINT_DATA 120\n";
  std::string text =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 6 5 4\nSPACING 1 2 3\n"
      "ORIGIN 0 0 0\nPOINT_DATA 120\nSCALARS s short\nLOOKUP_TABLE default\n";
  for (std::size_t i = 0; i < data.size(); i += 2) {
    std::int16_t v = 0;
    std::memcpy(&v, data.data() + i, 2);
    text += std::to_string(v) + "\n";
  }
  const double v = seventh;
  return {{"a.nrrd", nrrd + "encoding: raw\n\n" + data, v},
          {"z.nrrd", nrrd + "encoding: gzip\n\n" + gzip(scratch / "gz", data), v},
          {"a.mha", meta + "ElementDataFile = LOCAL\n" + data, v},
          {"a.nii", nifti(), 2 * v - 10},
          {"a.nii.gz", gzip(scratch / "gz", nifti()), 2 * v - 10},
          {"a.tif", tiff(), v},
          {"a.vtk", legacy + "SCALARS s short\nLOOKUP_TABLE default\n" + swapped + "\n", v},
          {"f.vtk", legacy + "FIELD FieldData 1\ns 1 120 short\n" + swapped + "\n", v},
          {"t.vtk", text, v}};
}

std::vector<std::string> write_library_files(const Scratch& scratch) {
  write_multi_material_data(scratch / "a.vtr", test::sample_data(Centering::kCells));
  write_multi_material_data(scratch / "a.vti", test::sample_data(Centering::kPoints, true));
  UnstructuredMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.connectivity = {0, 1, 2, 3, 1, 2, 3, 4};
  mesh.offsets = {0, 4, 8};
  mesh.cell_arrays = {{"owner", 1, std::vector<std::int32_t>{3, 4}}};
  mesh.field_arrays = {{"names", 1, std::vector<std::string>{"a", "b"}}};
  write_unstructured_mesh(scratch / "a.vtu", mesh);
  const InterfaceMesh cube = test::cube({0, 0, 0}, 1, "out", "in");
  for (const char* name : {"b.vtp", "b.ply", "b.off", "b.obj", "b.stl", "b.arec"}) {
    write_interface_mesh(scratch / name, cube);
  }
  return {"a.vtr", "a.vti", "a.vtu", "b.vtp", "b.ply", "b.off", "b.obj", "b.stl", "b.arec"};
}

TEST(BadInput, SamplesAreReadAsTheyAre) {
  const Scratch scratch;
  for (const Sample& sample : image_samples(scratch)) {
    put_bytes(scratch / sample.name, sample.bytes);
    GridFile file = read_grid_file(scratch / sample.name);
    EXPECT_EQ(file.nodes[0].size() * file.nodes[1].size() * file.nodes[2].size(), 120u) << sample.name;
    EXPECT_EQ(file.nodes[2].size(), 4u) << sample.name;
    ASSERT_EQ(file.arrays.size(), 1u) << sample.name;
    EXPECT_EQ(file.arrays[0].type, sample.name == "a.tif" ? "uint16" : "int16") << sample.name;
    EXPECT_EQ(file.arrays[0].take_floats().at(7), static_cast<float>(sample.value)) << sample.name;
  }
}

TEST(BadInput, MissingEmptyFolderAndForeignFilesAreNamed) {
  const Scratch scratch;
  for (const char* name : {"a.vti",    "a.vtr", "a.vtk", "a.nrrd", "a.nhdr", "a.mhd",      "a.mha", "a.nii",
                           "a.nii.gz", "a.tif", "a.png", "a.slc",  "a.raw",  "a.vtu",      "a.vtp", "a.arec",
                           "a.txt",    "a.obj", "a.off", "a.ply",  "a.stl",  "noextension"}) {
    const std::filesystem::path path = scratch / name;
    const auto summary_error = [&path] { return error_of([&path] { summarize_file(path); }); };
    EXPECT_EQ(summary_error(), path.string() + ": expected a file, found none");
    put_bytes(path, "");
    EXPECT_EQ(summary_error(), path.string() + ": expected data, found an empty file");
    put_bytes(path, "this is no such file\nat all\n");
    EXPECT_TRUE(says(summary_error(), path.string() + ": "));
    std::filesystem::remove(path);
    std::filesystem::create_directory(path);
    EXPECT_EQ(summary_error(), path.string() + ": expected a file, found a folder");
  }
}

TEST(BadInput, TruncatedImagesAreErrorsOrWhole) {
  const Scratch scratch;
  for (const Sample& sample : image_samples(scratch)) {
    put_bytes(scratch / sample.name, sample.bytes);
    const auto whole = read_grid_file(scratch / sample.name).arrays.at(0).values;
    std::size_t errors = 0;
    for (std::size_t step = 0; step < 24; ++step) {
      const std::size_t cut = step < 16 ? sample.bytes.size() * step / 16 : sample.bytes.size() - (step - 15);
      put_bytes(scratch / sample.name, sample.bytes.substr(0, cut));
      try {
        EXPECT_EQ(read_grid_file(scratch / sample.name).arrays.at(0).values, whole)
            << sample.name << " " << cut;
      } catch (const Error& error) {
        ++errors;
        EXPECT_TRUE(says(error.what(), sample.name + ": "));
      }
    }
    EXPECT_GE(errors, 16u) << sample.name;
  }
}

TEST(BadInput, TruncatedMeshesAreErrorsOrWhole) {
  const Scratch scratch;
  for (const std::string& name : write_library_files(scratch)) {
    const std::string bytes = bytes_of(scratch / name);
    const FileSummary whole = summarize_file(scratch / name);
    std::size_t errors = 0;
    for (std::size_t step = 0; step < 24; ++step) {
      const std::size_t cut = step < 16 ? bytes.size() * step / 16 : bytes.size() - (step - 15);
      put_bytes(scratch / name, bytes.substr(0, cut));
      try {
        const FileSummary read = summarize_file(scratch / name);
        if (name == "b.obj") continue;  // states no counts, so what is cut at the end of a line is whole
        EXPECT_EQ(read.points, whole.points) << name << " " << cut;
        EXPECT_EQ(read.cells, whole.cells) << name << " " << cut;
        EXPECT_EQ(read.arrays.size(), whole.arrays.size()) << name << " " << cut;
      } catch (const Error& error) {
        ++errors;
        EXPECT_TRUE(says(error.what(), name + ": "));
      }
    }
    EXPECT_GE(errors, name == "b.obj" ? 10u : 15u) << name;
  }
}

TEST(BadInput, FlippedBytesAreAnswered) {
  const Scratch scratch;
  std::mt19937 random(11);
  std::vector<std::string> names = write_library_files(scratch);
  for (const Sample& sample : image_samples(scratch)) {
    put_bytes(scratch / sample.name, sample.bytes);
    names.push_back(sample.name);
  }
  for (const std::string& name : names) {
    const std::string bytes = bytes_of(scratch / name);
    for (int trial = 0; trial < 20; ++trial) {
      std::string corrupt = bytes;
      // Half of the changes are in the first bytes, most of which are the header.
      const std::size_t range = trial % 2 == 0 ? corrupt.size() : std::min<std::size_t>(corrupt.size(), 400);
      for (int i = 0; i < 1 + trial % 5; ++i) corrupt[random() % range] = static_cast<char>(random());
      put_bytes(scratch / name, corrupt);
      try {
        summarize_file(scratch / name);
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
}

TEST(BadInput, HugeSizesAreErrors) {
  const Scratch scratch;
  const std::string tail = "encoding: raw\nendian: little\n\nxx";
  put_bytes(scratch / "a.nrrd",
            "NRRD0004\ntype: float\ndimension: 3\nsizes: 2000000000 2000000000 2\n" + tail);
  error_of([&] { read_grid_file(scratch / "a.nrrd"); });
  put_bytes(scratch / "b.nrrd", "NRRD0004\ntype: float\ndimension: 3\nsizes: 0 -5 2\n" + tail);
  error_of([&] { read_grid_file(scratch / "b.nrrd"); });
  put_bytes(scratch / "a.vtk",
            "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 90000 90000 "
            "90000\nSPACING 1 1 1\n"
            "ORIGIN 0 0 0\nPOINT_DATA 729000000000000\nSCALARS s double\nLOOKUP_TABLE default\nxxxx");
  EXPECT_TRUE(says(error_of([&] { read_grid_file(scratch / "a.vtk"); }), "a.vtk: array 's'"));
  put_bytes(scratch / "a.mha",
            "ObjectType = Image\nNDims = 3\nDimSize = 99999 99999 99999\nElementType = MET_FLOAT\n"
            "ElementDataFile = LOCAL\nxxxx");
  EXPECT_TRUE(says(error_of([&] { read_grid_file(scratch / "a.mha"); }), "a.mha: expected"));
  put_bytes(
      scratch / "b.mha",
      "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL");
  EXPECT_TRUE(says(error_of([&] { read_grid_file(scratch / "b.mha"); }),
                   "expected 8 bytes for 2 x 2 x 2 samples of uint8"));
}

TEST(BadInput, OneWholeNumberArraySaysWhatToPass) {
  const Scratch scratch;
  const auto samples = image_samples(scratch);
  put_bytes(scratch / "a.nrrd", samples[0].bytes);
  const auto message = error_of([&] { read_multi_material_data(scratch / "a.nrrd"); });
  EXPECT_TRUE(says(message, "found one array of whole numbers, 'a': pass --labels a if"));
  MaterialDataOptions options;
  options.labels = "a";
  const MultiMaterialData data = read_multi_material_data(scratch / "a.nrrd", options);
  EXPECT_EQ(data.labels.size(), 120u);
  EXPECT_TRUE(std::is_sorted(data.materials.begin(), data.materials.end(),
                             [](const auto& a, const auto& b) { return std::stoi(a) < std::stoi(b); }));
}

TEST(BadInput, FullDiskIsAnErrorAndLeavesNothing) {
  const Scratch scratch, empty;
  std::vector<std::pair<std::string, std::function<void(const std::filesystem::path&)>>> writers;
  const MultiMaterialData data = test::sample_data(Centering::kCells, true);
  for (const char* name : {"a.vtr", "a.vti"}) {
    writers.emplace_back(name, [&](const auto& path) { write_multi_material_data(path, data); });
  }
  const InterfaceMesh cube = test::cube({0, 0, 0}, 1.0 / 3, "out", "in");
  for (const char* name : {"b.vtp", "b.ply", "b.off", "b.obj", "b.stl", "b.arec"}) {
    writers.emplace_back(name, [&](const auto& path) { write_interface_mesh(path, cube); });
  }
  for (const auto& writer : writers) {
    const std::string& name = writer.first;
    const auto& write = writer.second;
    write(scratch / name);
    const auto size = std::filesystem::file_size(scratch / name);
    for (const std::uintmax_t room : {std::uintmax_t{0}, size / 2, size - 1}) {
      const test::FileSizeLimit limit(room);
      EXPECT_TRUE(
          says(error_of([&write, &name, &empty] { write(empty / name); }), name + ": could not be written"));
    }
    EXPECT_EQ(empty.entries(), 0) << name;
  }
}

}  // namespace
}  // namespace adamas
