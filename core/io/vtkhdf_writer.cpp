#include "core/io/vtkhdf_writer.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/io/hdf5_image.h"
#include "core/io/output_stream.h"

namespace adamas::io {

namespace {

constexpr std::uint8_t kTetrahedron = 10, kTriangle = 5, kPolygon = 7, kLine = 3, kPolyLine = 4;

/// The name of an array as that of a data set, in which '/' would make a group.
std::string data_set_name(std::string name) {
  for (std::size_t at = name.find('/'); at != std::string::npos; at = name.find('/', at))
    name.replace(at, 1, " per ");
  return name;
}

void add_arrays(const std::string& group, const std::vector<NamedArray>& arrays, Hdf5Image& file) {
  for (NamedArray array : arrays) {
    array.name = group + "/" + data_set_name(array.name);
    if (const auto* texts = std::get_if<std::vector<std::string>>(&array.values)) {
      file.add_texts(array.name, *texts);
    } else {
      file.add(array);
    }
  }
}

}  // namespace

std::uint8_t vtk_cell_type(CellKind kind, std::size_t corners) {
  if (kind == CellKind::kTetrahedra) return kTetrahedron;
  if (kind == CellKind::kLines) return corners == 2 ? kLine : kPolyLine;
  return corners == 3 ? kTriangle : kPolygon;
}

void write_vtkhdf(const std::filesystem::path& path, const UnstructuredMesh& mesh) {
  const std::string root = "VTKHDF";
  Hdf5Image file;
  file.add_attribute(root, "Version", std::array<std::int64_t, 2>{1, 0});
  file.add_attribute(root, "Type", "UnstructuredGrid");
  const auto count = [&](const char* name, std::size_t number) {
    file.add(root + "/" + name, std::array{static_cast<std::int64_t>(number)});
  };
  count("NumberOfPoints", mesh.points.size());
  count("NumberOfCells", mesh.cell_count());
  count("NumberOfConnectivityIds", mesh.connectivity.size());
  std::vector<double> coordinates;
  coordinates.reserve(3 * mesh.points.size());
  for (const Vec3& p : mesh.points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  file.add({root + "/Points", 3, std::move(coordinates)});
  file.add(root + "/Connectivity",
           std::vector<std::int64_t>(mesh.connectivity.begin(), mesh.connectivity.end()));
  file.add(root + "/Offsets", std::vector<std::int64_t>(mesh.offsets.begin(), mesh.offsets.end()));
  std::vector<std::uint8_t> types;
  for (std::size_t c = 0; c < mesh.cell_count(); ++c)
    types.push_back(vtk_cell_type(mesh.kind, mesh.offsets[c + 1] - mesh.offsets[c]));
  file.add({root + "/Types", 1, std::move(types)});
  add_arrays(root + "/PointData", mesh.point_arrays, file);
  add_arrays(root + "/CellData", mesh.cell_arrays, file);
  add_arrays(root + "/FieldData", mesh.field_arrays, file);
  OutputStream out(path);
  out.write(file.bytes());
  out.finish();
}

}  // namespace adamas::io
