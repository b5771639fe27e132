#include "adamas/files.h"

#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/data/interface_mesh.h"
#include "core/data/multi_material_data.h"
#include "core/data/solver_mesh.h"
#include "core/io/input_file.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/multi_material_reader.h"
#include "core/io/output_stream.h"
#include "core/io/reader_program.h"
#include "core/io/solver_mesh_io.h"
#include "core/io/surface_reader.h"
#include "core/io/surface_writer.h"
#include "core/io/unstructured_mesh_io.h"
#include "core/io/volume_input.h"
#include "core/io/volume_reader.h"
#include "core/io/volume_writer.h"

namespace adamas {

using namespace io;

namespace {

NamedArray to_named_array(const ArrayView& view) {
  NamedArray array{std::string(view.name), view.components, {}};
  std::visit([&array](const auto& values) { array.values = std::vector(values.begin(), values.end()); },
             view.values);
  return array;
}

std::vector<NamedArray> to_named_arrays(const std::vector<ArrayView>& views) {
  std::vector<NamedArray> arrays;
  for (const ArrayView& view : views) arrays.push_back(to_named_array(view));
  return arrays;
}

UnstructuredMesh to_unstructured_mesh(const TetrahedraView& view) {
  UnstructuredMesh mesh;
  mesh.points.assign(view.points.begin(), view.points.end());
  mesh.connectivity.reserve(4 * view.tetrahedra.size());
  for (const auto& t : view.tetrahedra) {
    mesh.connectivity.insert(mesh.connectivity.end(), t.begin(), t.end());
    mesh.offsets.push_back(mesh.connectivity.size());
  }
  mesh.point_arrays = to_named_arrays(view.point_arrays);
  mesh.cell_arrays = to_named_arrays(view.cell_arrays);
  mesh.field_arrays = to_named_arrays(view.mesh_arrays);
  return mesh;
}

}  // namespace

void set_reader_program(const std::filesystem::path& program) { set_own_program(kReaderProgram, program); }

OwnedGridData read_grid_data(const std::filesystem::path& path, const MaterialDataOptions& options,
                             Progress& progress) {
  check_input_file(path);
  return OwnedGridData(
      std::make_unique<MultiMaterialData>(read_multi_material_data(path, options, progress)));
}

Volume read_volume(const std::filesystem::path& path, const std::string& array, Progress& progress) {
  VolumeOptions options;
  options.array = array;
  return read_whole(open_volume(path, options, progress), path.string(), progress);
}

void write_volume(const std::filesystem::path& path, const VolumeGrid& grid,
                  std::span<const std::byte> samples) {
  grid.check(path.string());
  if (samples.size() != grid.bytes())
    fail("{}: expected {} bytes of samples, found {}", path.string(), grid.bytes(), samples.size());
  VolumeWriter writer(path, grid);
  const std::size_t plane = grid.plane_bytes();
  for (std::uint64_t k = 0; k < grid.dimensions[2]; ++k)
    writer.write_plane(samples.subspan(k * plane, plane));
  writer.finish();
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  OutputStream stream(path);
  stream.write(text);
  stream.finish();
}

InterfaceTriangles read_interfaces(const std::filesystem::path& path) {
  check_input_file(path);
  return to_interface_triangles(read_interface_mesh(path));
}

TriangleSurface read_surface(const std::filesystem::path& path) { return read_triangle_surface(path); }

MaterialTetrahedra read_tetrahedra(const std::filesystem::path& path) {
  check_input_file(path);
  SolverMesh mesh = read_solver_mesh(path);
  return {std::move(mesh.points), std::move(mesh.tetrahedra), std::move(mesh.block), std::move(mesh.blocks)};
}

void write_mesh(const std::filesystem::path& path, const InterfaceTriangles& mesh) {
  write_interface_mesh(path, to_interface_mesh(mesh, path.string()));
}

void write_mesh(const std::filesystem::path& path, const TriangleSurface& mesh, Progress& progress) {
  write_surface(path, mesh, progress);
}

void write_mesh(const std::filesystem::path& path, const MaterialTetrahedra& mesh) {
  SolverMesh solver;
  solver.points = mesh.points;
  solver.tetrahedra = mesh.tetrahedra;
  solver.block = mesh.tetrahedron_materials;
  solver.blocks = mesh.materials;
  write_solver_mesh(path, solver);
}

void write_mesh(const std::filesystem::path& path, const TetrahedraView& mesh) {
  write_unstructured_mesh(path, to_unstructured_mesh(mesh));
}

}  // namespace adamas
