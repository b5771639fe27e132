#include "core/io/unstructured_mesh_io.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <optional>

#include "core/base/error.h"
#include "core/base/release_memory.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/reader_program.h"
#include "core/io/vtk_checks.h"
#include "core/io/vtk_support.h"
#include "core/io/vtkhdf_writer.h"

namespace adamas::io {

template <>
inline constexpr auto kSentMembers<UnstructuredMesh> = std::tuple{
    &UnstructuredMesh::kind,        &UnstructuredMesh::points,       &UnstructuredMesh::connectivity,
    &UnstructuredMesh::offsets,     &UnstructuredMesh::point_arrays, &UnstructuredMesh::cell_arrays,
    &UnstructuredMesh::field_arrays};

namespace {

std::optional<CellKind> kind_of(int type) {
  if (type == VTK_TETRA) return CellKind::kTetrahedra;
  if (type == VTK_TRIANGLE || type == VTK_QUAD || type == VTK_POLYGON) return CellKind::kPolygons;
  if (type == VTK_LINE || type == VTK_POLY_LINE) return CellKind::kLines;
  return {};
}

void take_cells(const std::string& name, vtkCellArray* cells, UnstructuredMesh& mesh) {
  vtkDataArray* offsets = cells->GetOffsetsArray();
  vtkDataArray* connectivity = cells->GetConnectivityArray();
  const auto points = static_cast<double>(mesh.points.size());
  for (vtkIdType i = 0; i < connectivity->GetNumberOfTuples(); ++i) {
    const double p = connectivity->GetComponent(i, 0);
    if (!(p >= 0 && p < points)) fail("{}: cells: expected indices below {}, found {}", name, points, p);
    mesh.connectivity.push_back(static_cast<std::uint32_t>(p));
  }
  for (vtkIdType i = 1; i < offsets->GetNumberOfTuples(); ++i) {
    const double offset = offsets->GetComponent(i, 0);
    if (!(offset >= static_cast<double>(mesh.offsets.back()) &&
          offset <= static_cast<double>(mesh.connectivity.size()))) {
      fail("{}: cells: expected ascending offsets up to {}, found {} after {}", name,
           mesh.connectivity.size(), offset, mesh.offsets.back());
    }
    mesh.offsets.push_back(static_cast<std::size_t>(offset));
  }
  if (mesh.offsets.back() != mesh.connectivity.size()) {
    fail("{}: cells: expected {} indices, found {}", name, mesh.offsets.back(), mesh.connectivity.size());
  }
}

void take_arrays(const std::string& name, const char* place, vtkFieldData& source, std::size_t items,
                 std::vector<NamedArray>& arrays) {
  for (int i = 0; i < source.GetNumberOfArrays(); ++i) {
    vtkAbstractArray* array = source.GetAbstractArray(i);
    const auto found = static_cast<std::size_t>(array->GetNumberOfTuples());
    if (items != static_cast<std::size_t>(-1) && found != items) {
      fail("{}: {} array '{}': expected {} tuples, found {}", name, place, array->GetName(), items, found);
    }
    arrays.push_back(from_vtk(*array));
  }
}

void take_common(const std::string& name, vtkPointSet& source, UnstructuredMesh& mesh) {
  take_arrays(name, "point", *source.GetPointData(), mesh.points.size(), mesh.point_arrays);
  take_arrays(name, "cell", *source.GetCellData(), mesh.cell_count(), mesh.cell_arrays);
  take_arrays(name, "field", *source.GetFieldData(), static_cast<std::size_t>(-1), mesh.field_arrays);
}

void take_points(vtkPointSet& source, UnstructuredMesh& mesh) {
  for (vtkIdType i = 0; i < source.GetNumberOfPoints(); ++i) {
    std::array<double, 3> p{};
    source.GetPoints()->GetPoint(i, p.data());
    mesh.points.push_back({p[0], p[1], p[2]});
  }
}

UnstructuredMesh from_grid(const std::string& name, vtkUnstructuredGrid& grid) {
  UnstructuredMesh mesh;
  take_points(grid, mesh);
  std::optional<CellKind> kind;
  const vtkUnsignedCharArray* types = grid.GetCellTypesArray();
  for (vtkIdType c = 0; c < grid.GetNumberOfCells(); ++c) {
    const int type = const_cast<vtkUnsignedCharArray*>(types)->GetValue(c);
    const auto next = kind_of(type);
    if (!next)
      fail("{}: cell {}: expected a tetrahedron, polygon or line, found VTK's type {}", name, c, type);
    if (kind && kind != next) fail("{}: cell {}: expected cells of one kind, found another", name, c);
    kind = next;
  }
  mesh.kind = kind.value_or(CellKind::kTetrahedra);
  if (grid.GetNumberOfCells() > 0) take_cells(name, grid.GetCells(), mesh);
  for (std::size_t c = 0; mesh.kind == CellKind::kTetrahedra && c < mesh.cell_count(); ++c) {
    if (mesh.offsets[c + 1] - mesh.offsets[c] != 4)
      fail("{}: cell {}: expected four points of a tetrahedron", name, c);
  }
  take_common(name, grid, mesh);
  return mesh;
}

UnstructuredMesh from_surface(const std::string& name, vtkPolyData& surface) {
  UnstructuredMesh mesh;
  take_points(surface, mesh);
  const bool lines = surface.GetNumberOfLines() > 0;
  if (surface.GetNumberOfVerts() > 0 || surface.GetNumberOfStrips() > 0 ||
      (lines && surface.GetNumberOfPolys() > 0)) {
    fail("{}: expected polygons or lines alone, found {} vertices, {} lines, {} polygons, {} strips", name,
         surface.GetNumberOfVerts(), surface.GetNumberOfLines(), surface.GetNumberOfPolys(),
         surface.GetNumberOfStrips());
  }
  mesh.kind = lines ? CellKind::kLines : CellKind::kPolygons;
  take_cells(name, lines ? surface.GetLines() : surface.GetPolys(), mesh);
  take_common(name, surface, mesh);
  return mesh;
}

template <class Reader>
vtkSmartPointer<Reader> run(const std::string& name, const char* kind, const VtkMessages& messages) {
  const auto reader = vtkSmartPointer<Reader>::New();
  if (reader->CanReadFile(name.c_str()) == 0) fail("{}: expected {}, found something else", name, kind);
  reader->SetFileName(name.c_str());
  reader->Update();
  messages.check(name);
  if (reader->GetErrorCode() != 0 || reader->GetOutput() == nullptr) {
    fail("{}: expected a whole file, found a corrupt one", name);
  }
  return reader;
}

UnstructuredMesh read_with_vtk(const std::string& name, const std::string& extension) {
  const VtkMessages messages;
  if (extension == ".vtu") {
    const auto reader = run<vtkXMLUnstructuredGridReader>(name, "a VTK XML unstructured grid", messages);
    return from_grid(name, *reader->GetOutput());
  }
  if (extension == ".vtp") {
    const auto reader = run<vtkXMLPolyDataReader>(name, "VTK XML polygonal data", messages);
    return from_surface(name, *reader->GetOutput());
  }
  fail("{}: expected a mesh as .vtu or .vtp, found '{}'", name, extension);
}

}  // namespace

void send_mesh(const ReaderRequest& request, ByteSink& sink) {
  const std::string& path = request.paths.front();
  sink.put(read_with_vtk(path, file_extension(path)));
}

InputFormat vtu_format() { return {.name = "VTK XML mesh", .kind = InputKind::kMesh, .endings = ".vtu"}; }

InputFormat vtp_format() {
  return {.name = "VTK XML polygons", .kind = InputKind::kPolygons, .endings = ".vtp"};
}

UnstructuredMesh read_unstructured_mesh(const std::filesystem::path& path) {
  const ReaderRequest request = request_of(LibraryReader::kMesh, path);
  check_vtk_counts(read_xml_tags(supply_file(FileHandle::open(path), 0), path.string()), path);
  return receive_from_child<UnstructuredMesh>(request);
}

namespace {

/// Moves the points into an array of VTK's.
vtkSmartPointer<vtkPoints> take_points(UnstructuredMesh& mesh) {
  const auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.points.size()));
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    points->SetPoint(static_cast<vtkIdType>(i), mesh.points[i].x, mesh.points[i].y, mesh.points[i].z);
  }
  release_memory(mesh.points);
  return points;
}

/// Moves the cells into arrays of VTK's.
vtkSmartPointer<vtkCellArray> take_cells(UnstructuredMesh& mesh) {
  const auto offsets = vtkSmartPointer<vtkTypeInt64Array>::New();
  const auto connectivity = vtkSmartPointer<vtkTypeInt64Array>::New();
  offsets->SetNumberOfValues(static_cast<vtkIdType>(mesh.offsets.size()));
  connectivity->SetNumberOfValues(static_cast<vtkIdType>(mesh.connectivity.size()));
  std::copy(mesh.offsets.begin(), mesh.offsets.end(), offsets->GetPointer(0));
  std::copy(mesh.connectivity.begin(), mesh.connectivity.end(), connectivity->GetPointer(0));
  release_memory(mesh.offsets);
  release_memory(mesh.connectivity);
  const auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, connectivity);
  return cells;
}

/// Moves arrays into those of VTK's.
void add_arrays(const std::string& name, std::vector<NamedArray>& arrays, std::size_t items,
                vtkFieldData& target) {
  for (NamedArray& array : arrays) {
    const std::size_t size = std::visit([](const auto& values) { return values.size(); }, array.values);
    const auto components = static_cast<std::size_t>(std::max(array.components, 0));
    const bool any_length = items == static_cast<std::size_t>(-1);
    if (components == 0 || size % components != 0 || (!any_length && size != items * components)) {
      fail("{}: array '{}': expected {} values for each of {} items, found {} in all", name, array.name,
           array.components, any_length ? size : items, size);
    }
    target.AddArray(to_vtk(array));
    array.values = {};
  }
}

void add_all_arrays(const std::string& name, UnstructuredMesh& mesh, vtkDataSet& target) {
  add_arrays(name, mesh.point_arrays, mesh.points.size(), *target.GetPointData());
  add_arrays(name, mesh.cell_arrays, mesh.cell_count(), *target.GetCellData());
  add_arrays(name, mesh.field_arrays, static_cast<std::size_t>(-1), *target.GetFieldData());
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

void write_vtu(const std::filesystem::path& path, UnstructuredMesh& mesh) {
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  const auto types = vtkSmartPointer<vtkUnsignedCharArray>::New();
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    types->InsertNextValue(vtk_cell_type(mesh.kind, mesh.offsets[c + 1] - mesh.offsets[c]));
  }
  add_all_arrays(path.string(), mesh, *grid);
  grid->SetPoints(take_points(mesh));
  grid->SetCells(types, take_cells(mesh));
  const auto writer = vtkSmartPointer<vtkXMLUnstructuredGridWriter>::New();
  writer->SetInputData(grid);
  write_with_vtk(path, *writer);
}

void write_vtp(const std::filesystem::path& path, UnstructuredMesh& mesh) {
  if (mesh.kind == CellKind::kTetrahedra) fail("{}: expected .vtu for tetrahedra, found .vtp", path.string());
  const auto surface = vtkSmartPointer<vtkPolyData>::New();
  add_all_arrays(path.string(), mesh, *surface);
  surface->SetPoints(take_points(mesh));
  if (mesh.kind == CellKind::kPolygons) {
    surface->SetPolys(take_cells(mesh));
  } else {
    surface->SetLines(take_cells(mesh));
  }
  const auto writer = vtkSmartPointer<vtkXMLPolyDataWriter>::New();
  writer->SetInputData(surface);
  write_with_vtk(path, *writer);
}

}  // namespace

void write_unstructured_mesh(const std::filesystem::path& path, const UnstructuredMesh& mesh) {
  write_unstructured_mesh(path, UnstructuredMesh(mesh));
}

void write_unstructured_mesh(const std::filesystem::path& path, UnstructuredMesh&& mesh) {
  const std::string extension = file_extension(path);
  check_cells(path.string(), mesh);
  if (extension == ".vtu") {
    write_vtu(path, mesh);
  } else if (extension == ".vtp") {
    write_vtp(path, mesh);
  } else if (extension == ".vtkhdf") {
    write_vtkhdf(path, mesh);
  } else {
    fail("{}: expected .vtu, .vtkhdf or .vtp for a mesh, found '{}'", path.string(), extension);
  }
}

}  // namespace adamas::io
