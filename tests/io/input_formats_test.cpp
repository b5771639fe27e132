// Tests the registry of formats, and compares readers of .vti and .vtr in all their forms with VTK's own.

#include "core/io/input_formats.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkStringArray.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLRectilinearGridWriter.h>

#include <random>
#include <set>

#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::put_bytes;

std::set<std::string> endings_of(const InputFormat& format) {
  std::set<std::string> endings;
  std::istringstream words(std::string(format.endings) + " " + std::string(format.more_endings));
  for (std::string word; words >> word;) endings.insert(word);
  return endings;
}

TEST(InputFormats, EachEndingIsOfOneFormatAndInTheManual) {
  const std::string manual =
      test::bytes_of(std::filesystem::path(ADAMAS_SOURCE_DIR) / "docs" / "file_formats.md");
  std::set<std::string> all;
  for (const InputFormat& format : input_formats()) {
    for (const std::string& ending : endings_of(format)) {
      EXPECT_TRUE(all.insert(ending).second) << ending;
      EXPECT_EQ(find_format_by_name("a" + ending), &format) << ending;
      EXPECT_NE(manual.find("`" + ending + "`"), std::string::npos) << ending;
    }
  }
  EXPECT_EQ(find_format_by_name("a.unknown"), nullptr);
}

TEST(InputFormats, OneOfThemShowsInTheFirstBytes) {
  const test::Scratch scratch;
  const std::vector<std::pair<std::string, std::string>> beginnings{
      {"NRRD", "NRRD0004\n"},
      {"MetaImage", "ObjectType = Image\n"},
      {"NIfTI", std::string(344, 'x') + std::string("n+1\0", 4)},
      {"HDF5", "\x89HDF\r\n\x1a\n"},
      {"NumPy", "\x93NUMPY\1"},
      {"TIFF", std::string("MM\0*", 4)},
      {"PNG", "\x89PNG\r\n\x1a\n"},
      {"legacy VTK", "# vtk DataFile Version 3.0\n"},
      {"VTK XML image", "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\">"}};
  for (const auto& [name, bytes] : beginnings) {
    put_bytes(scratch / "a", bytes + "and so on");
    const InputFormat* format = find_input_format(scratch / "a");
    ASSERT_NE(format, nullptr) << name;
    EXPECT_EQ(format->name, name);
  }
  put_bytes(scratch / "a", "nothing that is known");
  EXPECT_EQ(find_input_format(scratch / "a"), nullptr);
}

vtkSmartPointer<vtkDataArray> random_array(int type, const char* name, int components, vtkIdType count) {
  auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(count);
  std::mt19937 random(7);
  for (vtkIdType i = 0; i < count; ++i) {
    for (int c = 0; c < components; ++c) array->SetComponent(i, c, static_cast<double>(random() % 100));
  }
  return array;
}

/// Returns an image with cell and point arrays of every type, vectors, names of materials and ghosts, on an
/// extent that does not begin at 0.
vtkSmartPointer<vtkImageData> image_of_everything() {
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(-2, 2, 1, 4, 0, 2);
  image->SetSpacing(0.5, 3.25, 2);
  image->SetOrigin(1, -2, 3.1);
  const vtkIdType points = image->GetNumberOfPoints(), cells = image->GetNumberOfCells();
  for (const int type :
       {VTK_FLOAT, VTK_DOUBLE, VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_UNSIGNED_SHORT, VTK_INT,
        VTK_UNSIGNED_INT, VTK_LONG_LONG, VTK_UNSIGNED_LONG_LONG}) {
    const std::string name = "array " + std::to_string(type);
    image->GetPointData()->AddArray(random_array(type, name.c_str(), 1, points));
    image->GetCellData()->AddArray(random_array(type, name.c_str(), 2, cells));
  }
  const auto large = random_array(VTK_LONG_LONG, "large", 1, points);
  large->SetComponent(3, 0, 1e12);
  image->GetPointData()->AddArray(large);
  image->GetPointData()->AddArray(random_array(VTK_FLOAT, "vector", 3, points));
  image->GetCellData()->AddArray(random_array(VTK_UNSIGNED_CHAR, "vtkGhostType", 1, cells));
  vtkNew<vtkStringArray> names;
  names->SetName("material_names");
  for (const char* name : {"air", "Body, Nose", "\xc3\xa4"}) names->InsertNextValue(name);
  image->GetFieldData()->AddArray(names);
  return image;
}

/// Returns a rectilinear grid with the same arrays, and with coordinates of two types.
vtkSmartPointer<vtkRectilinearGrid> rectilinear_grid_of_everything() {
  const auto image = image_of_everything();
  auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
  grid->SetExtent(image->GetExtent());
  const auto axis = [](int type, const char* name, vtkIdType count) {
    auto places = random_array(type, name, 1, count);
    for (vtkIdType i = 1; i < count; ++i)
      places->SetComponent(i, 0, places->GetComponent(i - 1, 0) + 0.1 + places->GetComponent(i, 0));
    return places;
  };
  grid->SetXCoordinates(axis(VTK_DOUBLE, "x", 5));
  grid->SetYCoordinates(axis(VTK_FLOAT, "y", 4));
  grid->SetZCoordinates(axis(VTK_DOUBLE, "z", 3));
  grid->GetPointData()->ShallowCopy(image->GetPointData());
  grid->GetCellData()->ShallowCopy(image->GetCellData());
  grid->GetFieldData()->ShallowCopy(image->GetFieldData());
  return grid;
}

void expect_same(const GridFile& found, const GridFile& expected, const std::string& name) {
  EXPECT_EQ(found.kind, expected.kind) << name;
  EXPECT_EQ(found.nodes, expected.nodes) << name;
  EXPECT_EQ(found.material_names, expected.material_names) << name;
  EXPECT_EQ(found.has_samples(), expected.has_samples()) << name;
  ASSERT_EQ(found.arrays.size(), expected.arrays.size()) << name;
  for (std::size_t i = 0; i < found.arrays.size(); ++i) {
    const GridArray &a = found.arrays[i], &b = expected.arrays[i];
    EXPECT_EQ(a.name, b.name) << name;
    EXPECT_EQ(a.type, b.type) << name << " " << a.name;
    EXPECT_EQ(a.centering, b.centering) << name << " " << a.name;
    EXPECT_EQ(a.components, b.components) << name << " " << a.name;
    EXPECT_EQ(a.values, b.values) << name << " " << a.name;
  }
}

/// Writes the data in every form that files of VTK have.
template <class Writer>
void expect_every_form(vtkDataObject* data, const char* extension) {
  const test::Scratch scratch;
  int number = 0;
  for (const int mode : {Writer::Ascii, Writer::Binary, Writer::Appended}) {
    for (const int compressor : {Writer::NONE, Writer::ZLIB, Writer::LZ4, Writer::LZMA}) {
      for (const bool other : {false, true}) {
        const std::filesystem::path path = scratch / fmt::format("{}{}", number++, extension);
        vtkNew<Writer> writer;
        writer->SetInputData(data);
        writer->SetDataMode(mode);
        writer->SetCompressorType(compressor);
        writer->SetEncodeAppendedData(other ? 1 : 0);
        writer->SetByteOrder(other ? Writer::BigEndian : Writer::LittleEndian);
        writer->SetHeaderType(other ? Writer::UInt32 : Writer::UInt64);
        writer->SetFileName(path.c_str());
        ASSERT_EQ(writer->Write(), 1);
        expect_same(read_grid_file(path), read_grid_by_library(path),
                    fmt::format("mode {} compressor {} other {}", mode, compressor, other));
      }
    }
  }
}

TEST(VtkGrids, EveryFormIsReadAsVtkReadsIt) {
  expect_every_form<vtkXMLImageDataWriter>(image_of_everything(), ".vti");
  expect_every_form<vtkXMLRectilinearGridWriter>(rectilinear_grid_of_everything(), ".vtr");
}

}  // namespace
}  // namespace adamas
