#include "core/io/multi_material_writer.h"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLRectilinearGridWriter.h>

#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/output_stream.h"
#include "core/io/vtk_support.h"
#include "core/io/xml_file.h"

namespace adamas::io {

namespace {

template <class T>
void add(vtkDataSetAttributes& target, const std::string& name, int components, const SiteArray<T>& values) {
  target.AddArray(to_vtk({name, components, std::vector<T>(values.begin(), values.end())}));
}

void add_arrays(const MultiMaterialData& data, vtkDataSet& set) {
  vtkDataSetAttributes& target = data.grid.centering == Centering::kCells
                                     ? static_cast<vtkDataSetAttributes&>(*set.GetCellData())
                                     : static_cast<vtkDataSetAttributes&>(*set.GetPointData());
  if (data.labels.empty()) {
    for (MaterialId m(0); m.value < data.materials.size(); ++m.value) {
      add(target, "Volume Fraction for " + data.materials[m], 1, data.fractions[m]);
    }
  } else {
    const SiteArray<std::uint16_t> labels = data.labels.dense();
    target.AddArray(to_vtk({"labels", 1, std::vector<std::int32_t>(labels.begin(), labels.end())}));
    set.GetFieldData()->AddArray(to_vtk({"material_names", 1, std::vector<std::string>(data.materials)}));
  }
  for (const Field& field : data.fields) {
    const std::string unit = field.unit.empty() ? "" : " [" + field.unit + "]";
    const auto add_field = [&](const std::string& name, const FieldValues& values) {
      values.visit([&](const auto& array) { add(target, name + unit, field.components, array); });
    };
    if (!field.per_material()) add_field(field.name, field.values);
    for (MaterialId m(0); m.value < field.material_values.size(); ++m.value) {
      if (field.material_values[m].empty()) continue;
      add_field(field.name + " for " + data.materials[m], field.material_values[m]);
    }
  }
}

void write_rectilinear(const std::filesystem::path& path, const MultiMaterialData& data) {
  const auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
  std::array<vtkSmartPointer<vtkAbstractArray>, 3> axes;
  std::array<int, 3> size{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    axes[axis] = to_vtk({std::string(1, "xyz"[axis]), 1, data.grid.nodes[axis]});
    size[axis] = static_cast<int>(data.grid.nodes[axis].size());
  }
  grid->SetDimensions(size.data());
  grid->SetXCoordinates(vtkDataArray::SafeDownCast(axes[0]));
  grid->SetYCoordinates(vtkDataArray::SafeDownCast(axes[1]));
  grid->SetZCoordinates(vtkDataArray::SafeDownCast(axes[2]));
  add_arrays(data, *grid);
  const auto writer = vtkSmartPointer<vtkXMLRectilinearGridWriter>::New();
  writer->SetInputData(grid);
  write_with_vtk(path, *writer);
}

void write_image(const std::filesystem::path& path, const MultiMaterialData& data) {
  const auto image = vtkSmartPointer<vtkImageData>::New();
  std::array<int, 3> size{};
  std::array<double, 3> origin{}, spacing{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& nodes = data.grid.nodes[axis];
    size[axis] = static_cast<int>(nodes.size());
    origin[axis] = nodes.front();
    spacing[axis] = (nodes.back() - nodes.front()) / static_cast<double>(nodes.size() - 1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double even = origin[axis] + static_cast<double>(i) * spacing[axis];
      if (std::abs(nodes[i] - even) > 1e-9 * (nodes.back() - nodes.front())) {
        fail("{}: expected evenly spaced nodes for .vti, found {} for {} along {}: use .vtr", path.string(),
             nodes[i], even, "xyz"[axis]);
      }
    }
  }
  image->SetDimensions(size.data());
  image->SetOrigin(origin.data());
  image->SetSpacing(spacing.data());
  add_arrays(data, *image);
  const auto writer = vtkSmartPointer<vtkXMLImageDataWriter>::New();
  writer->SetInputData(image);
  write_with_vtk(path, *writer);
}

}  // namespace

void write_multi_material_data(const std::filesystem::path& path, const MultiMaterialData& data) {
  data.check();
  const std::string extension = file_extension(path);
  if (extension == ".vtr") {
    write_rectilinear(path, data);
  } else if (extension == ".vti") {
    write_image(path, data);
  } else {
    fail("{}: expected .vtr or .vti for data on a grid, found '{}'", path.string(), extension);
  }
}

}  // namespace adamas::io
