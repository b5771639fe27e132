#include "core/io/surface_reader.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/polygon_soup.h"
#include "core/io/surface_ply.h"
#include "core/io/unstructured_mesh_io.h"

namespace adamas::io {

namespace {

void add_polygon(const std::uint32_t* corners, std::size_t count, TriangleSurface& surface) {
  const auto triangles = triangulate_polygon(surface.points, corners, count);
  surface.triangles.insert(surface.triangles.end(), triangles.begin(), triangles.end());
}

/// Takes the numbers of an array of one value for each point as floats; returns false for other arrays.
bool take_values(const NamedArray& array, std::size_t points, std::vector<float>& values) {
  return std::visit(
      [&]<class T>(const std::vector<T>& given) {
        if constexpr (std::is_arithmetic_v<T>) {
          if (given.size() != points) return false;
          values.resize(points);
          std::transform(given.begin(), given.end(), values.begin(),
                         [](T value) { return static_cast<float>(value); });
          return true;
        }
        return false;
      },
      array.values);
}

TriangleSurface read_vtp(const std::filesystem::path& path) {
  UnstructuredMesh mesh = read_unstructured_mesh(path);
  if (mesh.kind != CellKind::kPolygons) fail("{}: expected polygons, found other cells", path.string());
  TriangleSurface surface;
  surface.points = std::move(mesh.points);
  for (std::size_t c = 0; c < mesh.cell_count(); ++c)
    add_polygon(mesh.connectivity.data() + mesh.offsets[c], mesh.offsets[c + 1] - mesh.offsets[c], surface);
  for (const NamedArray& array : mesh.point_arrays) {
    std::vector<float> numbers;
    if (array.name == "Normals" && array.components == 3 &&
        take_values(array, 3 * surface.points.size(), numbers)) {
      for (std::size_t i = 0; i < numbers.size(); i += 3)
        surface.normals.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    } else if (array.components == 1 && surface.values.empty() &&
               take_values(array, surface.points.size(), surface.values)) {
      surface.value_name = array.name;
    }
  }
  return surface;
}

TriangleSurface read_polygons(const std::filesystem::path& path) {
  PolygonSoup soup = read_polygon_soup(path);
  TriangleSurface surface;
  surface.points = std::move(soup.points);
  for (std::size_t f = 0; f + 1 < soup.offsets.size(); ++f)
    add_polygon(soup.corners.data() + soup.offsets[f], soup.offsets[f + 1] - soup.offsets[f], surface);
  return surface;
}

}  // namespace

TriangleSurface read_triangle_surface(const std::filesystem::path& path) {
  check_input_file(path);
  const std::string extension = file_extension(path);
  TriangleSurface surface;
  if (extension == ".vtp") {
    surface = read_vtp(path);
  } else if (extension == ".ply" && is_surface_ply(path)) {
    return parse_surface_ply(read_file(path), path.string());
  } else if (extension == ".ply" || extension == ".obj" || extension == ".off" || extension == ".stl") {
    surface = read_polygons(path);
  } else {
    fail("{}: expected a surface as .ply, .obj, .off, .stl or .vtp, found '{}'", path.string(), extension);
  }
  surface.check(path.string());
  return surface;
}

}  // namespace adamas::io
