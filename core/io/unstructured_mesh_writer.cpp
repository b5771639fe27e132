#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/unstructured_mesh_io.h"
#include "core/io/vtk_support.h"

namespace adamas::io {

namespace {

vtkSmartPointer<vtkPoints> points_of(const UnstructuredMesh& mesh) {
  const auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.points.size()));
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    points->SetPoint(static_cast<vtkIdType>(i), mesh.points[i].x, mesh.points[i].y, mesh.points[i].z);
  }
  return points;
}

vtkSmartPointer<vtkCellArray> cells_of(const UnstructuredMesh& mesh) {
  const auto offsets = vtkSmartPointer<vtkTypeInt64Array>::New();
  const auto connectivity = vtkSmartPointer<vtkTypeInt64Array>::New();
  offsets->SetNumberOfValues(static_cast<vtkIdType>(mesh.offsets.size()));
  connectivity->SetNumberOfValues(static_cast<vtkIdType>(mesh.connectivity.size()));
  std::copy(mesh.offsets.begin(), mesh.offsets.end(), offsets->GetPointer(0));
  std::copy(mesh.connectivity.begin(), mesh.connectivity.end(), connectivity->GetPointer(0));
  const auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, connectivity);
  return cells;
}

void add_arrays(const std::string& name, const std::vector<NamedArray>& arrays, std::size_t items,
                vtkFieldData& target) {
  for (const NamedArray& array : arrays) {
    const std::size_t size = std::visit([](const auto& values) { return values.size(); }, array.values);
    const auto components = static_cast<std::size_t>(std::max(array.components, 0));
    const bool any_length = items == static_cast<std::size_t>(-1);
    if (components == 0 || size % components != 0 || (!any_length && size != items * components)) {
      fail("{}: array '{}': expected {} values for each of {} items, found {} in all", name, array.name,
           array.components, any_length ? size : items, size);
    }
    target.AddArray(to_vtk(array));
  }
}

void add_all_arrays(const std::string& name, const UnstructuredMesh& mesh, vtkDataSet& target) {
  add_arrays(name, mesh.point_arrays, mesh.points.size(), *target.GetPointData());
  add_arrays(name, mesh.cell_arrays, mesh.cell_count(), *target.GetCellData());
  add_arrays(name, mesh.field_arrays, static_cast<std::size_t>(-1), *target.GetFieldData());
}

int cell_type(CellKind kind, std::size_t corners) {
  if (kind == CellKind::kTetrahedra) return VTK_TETRA;
  if (kind == CellKind::kLines) return corners == 2 ? VTK_LINE : VTK_POLY_LINE;
  return corners == 3 ? VTK_TRIANGLE : VTK_POLYGON;
}

void check_cells(const std::string& name, const UnstructuredMesh& mesh) {
  bool good =
      !mesh.offsets.empty() && mesh.offsets.front() == 0 && mesh.offsets.back() == mesh.connectivity.size();
  for (std::size_t c = 0; good && c < mesh.cell_count(); ++c) good = mesh.offsets[c] <= mesh.offsets[c + 1];
  for (std::size_t c = 0; good && mesh.kind == CellKind::kTetrahedra && c < mesh.cell_count(); ++c) {
    good = mesh.offsets[c + 1] - mesh.offsets[c] == 4;
  }
  for (const std::uint32_t p : mesh.connectivity) good = good && p < mesh.points.size();
  if (!good) fail("{}: expected cells with points of the mesh, found others", name);
}

void write_vtu(const std::filesystem::path& path, const UnstructuredMesh& mesh) {
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  const auto types = vtkSmartPointer<vtkUnsignedCharArray>::New();
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    types->InsertNextValue(
        static_cast<unsigned char>(cell_type(mesh.kind, mesh.offsets[c + 1] - mesh.offsets[c])));
  }
  grid->SetPoints(points_of(mesh));
  grid->SetCells(types, cells_of(mesh));
  add_all_arrays(path.string(), mesh, *grid);
  const auto writer = vtkSmartPointer<vtkXMLUnstructuredGridWriter>::New();
  writer->SetInputData(grid);
  write_with_vtk(path, *writer);
}

void write_vtp(const std::filesystem::path& path, const UnstructuredMesh& mesh) {
  if (mesh.kind == CellKind::kTetrahedra) fail("{}: expected .vtu for tetrahedra, found .vtp", path.string());
  const auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points_of(mesh));
  if (mesh.kind == CellKind::kPolygons) {
    surface->SetPolys(cells_of(mesh));
  } else {
    surface->SetLines(cells_of(mesh));
  }
  add_all_arrays(path.string(), mesh, *surface);
  const auto writer = vtkSmartPointer<vtkXMLPolyDataWriter>::New();
  writer->SetInputData(surface);
  write_with_vtk(path, *writer);
}

}  // namespace

void write_unstructured_mesh(const std::filesystem::path& path, const UnstructuredMesh& mesh) {
  const std::string extension = file_extension(path);
  check_cells(path.string(), mesh);
  if (extension == ".vtu") {
    write_vtu(path, mesh);
  } else if (extension == ".vtp") {
    write_vtp(path, mesh);
  } else {
    fail("{}: expected .vtu or .vtp for a mesh, found '{}'", path.string(), extension);
  }
}

}  // namespace adamas::io
