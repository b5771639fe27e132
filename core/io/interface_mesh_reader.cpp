#include <algorithm>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/network_ply.h"
#include "core/io/network_text.h"
#include "core/io/polygon_soup.h"
#include "core/io/unstructured_mesh_io.h"

namespace adamas::io {

namespace {

const NamedArray& named(const std::vector<NamedArray>& arrays, const std::string& name,
                        const std::string& file) {
  const auto found =
      std::find_if(arrays.begin(), arrays.end(), [&](const auto& a) { return a.name == name; });
  if (found == arrays.end()) fail("{}: expected an array '{}' of an interface mesh, found none", file, name);
  return *found;
}

template <class T>
const std::vector<T>& values(const NamedArray& array, std::size_t count, const std::string& file) {
  const auto* result = std::get_if<std::vector<T>>(&array.values);
  if (result == nullptr || result->size() != count) {
    fail("{}: array '{}': expected {} values of another type", file, array.name, count);
  }
  return *result;
}

InterfaceMesh from_polygons(const UnstructuredMesh& polygons, const std::string& file) {
  InterfaceMesh mesh;
  mesh.source = file;
  mesh.points = polygons.points;
  const NamedArray& names = named(polygons.field_arrays, "material_names", file);
  if (const auto* strings = std::get_if<std::vector<std::string>>(&names.values)) {
    mesh.materials.assign(strings->begin(), strings->end());
  }
  const auto& front =
      values<std::int32_t>(named(polygons.cell_arrays, "front", file), polygons.cell_count(), file);
  const auto& back =
      values<std::int32_t>(named(polygons.cell_arrays, "back", file), polygons.cell_count(), file);
  const auto material = [&](std::int32_t index) {
    if (index < 0 || static_cast<std::size_t>(index) >= mesh.materials.size()) {
      fail("{}: expected the index of one of {} materials, found {}", file, mesh.materials.size(), index);
    }
    return MaterialId(static_cast<std::size_t>(index));
  };
  for (std::size_t c = 0; c < polygons.cell_count(); ++c) {
    const std::uint32_t* corners = polygons.connectivity.data() + polygons.offsets[c];
    for (const auto& t :
         triangulate_polygon(mesh.points, corners, polygons.offsets[c + 1] - polygons.offsets[c])) {
      mesh.triangles.push_back({t, material(front[c]), material(back[c])});
    }
  }
  return mesh;
}

bool is_of_kind(const std::filesystem::path& path, InputKind kind) {
  const InputFormat* format = find_format_by_name(path);
  return format != nullptr && format->kind == kind;
}

}  // namespace

InputFormat network_format() {
  return {.name = "labelled network", .kind = InputKind::kNetwork, .endings = ".arec .txt"};
}

InputFormat surface_format() {
  return {.name = "surface", .kind = InputKind::kSurface, .endings = ".obj .off .ply .stl"};
}

bool is_network_file(const std::filesystem::path& path) { return is_of_kind(path, InputKind::kNetwork); }

bool is_surface_file(const std::filesystem::path& path) { return is_of_kind(path, InputKind::kSurface); }

InterfaceMesh read_labelled_network(const std::filesystem::path& path,
                                    const std::filesystem::path& region_names) {
  const std::string text = read_file(path);
  const LabelledNetwork network = parse_labelled_network(text, path.string());
  std::map<std::int32_t, std::string> names;
  if (!region_names.empty()) names = parse_region_names(read_file(region_names), region_names.string());
  return to_interface_mesh(network, names, path.string());
}

InterfaceMesh read_surface(const std::filesystem::path& path, const std::string& front_material,
                           const std::string& back_material) {
  if (front_material == back_material) {
    fail("{}: expected two different materials, found '{}' on both sides", path.string(), front_material);
  }
  const PolygonSoup soup = read_polygon_soup(path);
  InterfaceMesh mesh;
  mesh.source = path.string();
  mesh.points = soup.points;
  mesh.materials = {front_material, back_material};
  for (std::size_t f = 0; f + 1 < soup.offsets.size(); ++f) {
    const std::uint32_t* corners = soup.corners.data() + soup.offsets[f];
    for (const auto& t : triangulate_polygon(mesh.points, corners, soup.offsets[f + 1] - soup.offsets[f])) {
      mesh.triangles.push_back({t, MaterialId(0), MaterialId(1)});
    }
  }
  weld(mesh);
  return mesh;
}

InterfaceMesh read_interface_mesh(const std::filesystem::path& path) {
  if (file_extension(path) == ".vtp") return from_polygons(read_unstructured_mesh(path), path.string());
  if (file_extension(path) == ".ply") return read_network_ply(path);
  return read_labelled_network(path);
}

}  // namespace adamas::io
