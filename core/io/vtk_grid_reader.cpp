#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkHDFReader.h>
#include <vtkImageData.h>
#include <vtkImageReader2.h>
#include <vtkImageReader2Factory.h>
#include <vtkMatrix3x3.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPImageDataReader.h>
#include <vtkXMLPRectilinearGridReader.h>
#include <vtkXMLRectilinearGridReader.h>

#include "core/base/error.h"
#include "core/io/grid_axes.h"
#include "core/io/grid_file.h"
#include "core/io/input_file.h"
#include "core/io/png_image.h"
#include "core/io/tiff_pages.h"
#include "core/io/vtk_arrays.h"
#include "core/io/vtk_support.h"

namespace adamas::io {

namespace {

void add_arrays(vtkDataSetAttributes& attributes, Centering centering, GridFile& file) {
  for (int i = 0; i < attributes.GetNumberOfArrays(); ++i) {
    vtkDataArray* array = attributes.GetArray(i);
    if (array == nullptr || attributes.GetAbstractArray(i)->GetName() == std::string("vtkGhostType"))
      continue;
    file.arrays.push_back(grid_array(*array, centering));
  }
}

/// Whether a format states that its arrays are on cells or points, or has samples that may be either.
enum class ArrayPlaces { kStated, kSamples };

/// Adds nodes, and the faces of cells round samples, as distances along the array's axes.
void add_axes(vtkImageData& image, ArrayPlaces places, GridFile& file) {
  const int* extent = image.GetExtent();
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double step = image.GetSpacing()[axis];
    const int first = extent[2 * axis], last = extent[2 * axis + 1];
    for (int i = first; i <= last; ++i) file.nodes[a].push_back(i * step);
    if (places == ArrayPlaces::kStated) continue;
    for (int i = first; i <= last + 1; ++i) file.faces[a].push_back((i - 0.5) * step);
  }
}

GridAxes axes_of(vtkImageData& image) {
  GridAxes axes;
  for (int row = 0; row < 3; ++row) {
    axes.origin[row] = image.GetOrigin()[row];
    for (int column = 0; column < 3; ++column) {
      axes.directions[static_cast<std::size_t>(column)][row] =
          image.GetDirectionMatrix()->GetElement(row, column);
    }
  }
  return axes;
}

void add_axes(vtkRectilinearGrid& grid, GridFile& file) {
  const std::array<vtkDataArray*, 3> axes{grid.GetXCoordinates(), grid.GetYCoordinates(),
                                          grid.GetZCoordinates()};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (vtkIdType i = 0; axes[axis] != nullptr && i < axes[axis]->GetNumberOfTuples(); ++i) {
      file.nodes[axis].push_back(axes[axis]->GetComponent(i, 0));
    }
  }
}

void add_data(const std::string& name, vtkDataObject* data, ArrayPlaces places, GridFile& file) {
  auto* image = vtkImageData::SafeDownCast(data);
  if (image != nullptr) {
    add_axes(*image, places, file);
  } else if (auto* grid = vtkRectilinearGrid::SafeDownCast(data)) {
    add_axes(*grid, file);
  } else {
    fail("{}: expected an image or a rectilinear grid, found {}", name,
         data ? data->GetClassName() : "nothing");
  }
  auto* set = vtkDataSet::SafeDownCast(data);
  if (set->GetNumberOfPoints() == 0) fail("{}: expected a grid, found no point", name);
  add_arrays(*set->GetCellData(), Centering::kCells, file);
  add_arrays(*set->GetPointData(), Centering::kPoints, file);
  auto* names = vtkStringArray::SafeDownCast(set->GetFieldData()->GetAbstractArray("material_names"));
  for (vtkIdType i = 0; names != nullptr && i < names->GetNumberOfValues(); ++i) {
    file.material_names.push_back(names->GetValue(i));
  }
  if (image != nullptr) lay_out(axes_of(*image), file);
}

/// Reads a format that states where its arrays are.
template <class Reader>
GridFile read_stated(const std::string& name, const char* kind, const VtkMessages& messages) {
  GridFile file;
  file.kind = kind;
  add_data(name, read_if_readable<Reader>(name, fmt::format("a {}", kind), messages), ArrayPlaces::kStated,
           file);
  return file;
}

GridFile read_legacy(const std::string& name, const VtkMessages& messages) {
  GridFile file;
  file.kind = "legacy VTK";
  add_data(name, read_legacy_vtk(name, messages), ArrayPlaces::kStated, file);
  return file;
}

/// Whether a list like ".png .jpg" contains the extension.
bool lists_extension(const char* list, const std::string& extension) {
  return list != nullptr && !extension.empty() &&
         fmt::format(" {} ", list).find(fmt::format(" {} ", extension)) != std::string::npos;
}

/// Reads a format of plain images, whose one array has no name of its own.
GridFile read_image(const std::filesystem::path& path, const std::string& extension,
                    const VtkMessages& messages) {
  const std::string name = path.string();
  if (extension == ".png") check_png(path);
  GridFile file;
  const auto reader = vtk::TakeSmartPointer(vtkImageReader2Factory::CreateImageReader2(name.c_str()));
  // Some readers claim files of any kind, so the extension has to agree as well.
  if (reader == nullptr || !lists_extension(reader->GetFileExtensions(), extension))
    fail("{}: expected a grid or image format that is known, found none", name);
  file.kind = reader->GetDescriptiveName();
  add_data(name, read_with_vtk(*reader, name, messages), ArrayPlaces::kSamples, file);
  if (file.arrays.size() == 1) file.arrays[0].name = file_stem(path);
  return file;
}

}  // namespace

GridFile read_grid_with_vtk(const std::filesystem::path& path) {
  const VtkMessages messages;
  const std::string name = path.string(), extension = file_extension(path);
  GridFile file;
  if (extension == ".vti") {
    file = read_stated<vtkXMLImageDataReader>(name, "VTK XML image", messages);
  } else if (extension == ".pvti") {
    file = read_stated<vtkXMLPImageDataReader>(name, "VTK XML image in pieces", messages);
  } else if (extension == ".vtr") {
    file = read_stated<vtkXMLRectilinearGridReader>(name, "VTK XML rectilinear grid", messages);
  } else if (extension == ".pvtr") {
    file = read_stated<vtkXMLPRectilinearGridReader>(name, "VTK XML rectilinear grid in pieces", messages);
  } else if (extension == ".vtkhdf") {
    file = read_stated<vtkHDFReader>(name, "VTKHDF image", messages);
  } else if (extension == ".vtk") {
    file = read_legacy(name, messages);
  } else if (extension == ".tif" || extension == ".tiff") {
    file = read_tiff_stack(path);
  } else {
    file = read_image(path, extension, messages);
  }
  messages.check(name);
  return file;
}

}  // namespace adamas::io
