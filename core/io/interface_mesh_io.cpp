#include "core/io/interface_mesh_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <unordered_map>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/release_memory.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/labelled_network.h"
#include "core/io/network_ply.h"
#include "core/io/output_stream.h"
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
  std::map<std::int64_t, std::string> names;
  if (!region_names.empty()) names = parse_region_table(read_file(region_names), region_names.string()).names;
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

namespace {

struct PointHash {
  std::size_t operator()(const Vec3& p) const {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      // -0 equals 0, so both get one hash.
      hash = hash_combine(hash, std::bit_cast<std::uint64_t>(p[axis] + 0.0));
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash);
  }
};

}  // namespace

void weld(InterfaceMesh& mesh) {
  std::unordered_map<Vec3, std::uint32_t, PointHash> found;
  found.reserve(mesh.points.size());
  std::vector<std::uint32_t> target(mesh.points.size());
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const auto [at, added] = found.try_emplace(mesh.points[i], static_cast<std::uint32_t>(points.size()));
    if (added) points.push_back(mesh.points[i]);
    target[i] = at->second;
  }
  mesh.points = std::move(points);
  std::vector<InterfaceTriangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (InterfaceTriangle triangle : mesh.triangles) {
    for (std::uint32_t& p : triangle.points) p = target[p];
    const auto& [a, b, c] = triangle.points;
    if (a != b && b != c && c != a) triangles.push_back(triangle);
  }
  mesh.triangles = std::move(triangles);
}

InterfaceMesh merge(std::span<const InterfaceMesh> meshes) {
  InterfaceMesh result;
  for (const InterfaceMesh& mesh : meshes) {
    result.source += (result.source.empty() ? "" : ", ") + mesh.source;
    IdVector<MaterialId, MaterialId> materials;
    for (const std::string& name : mesh.materials) {
      const auto at = std::find(result.materials.begin(), result.materials.end(), name);
      materials.push_back(MaterialId(static_cast<std::size_t>(at - result.materials.begin())));
      if (at == result.materials.end()) result.materials.push_back(name);
    }
    const auto first = static_cast<std::uint32_t>(result.points.size());
    result.points.insert(result.points.end(), mesh.points.begin(), mesh.points.end());
    for (InterfaceTriangle triangle : mesh.triangles) {
      for (std::uint32_t& p : triangle.points) p += first;
      triangle.front = materials[triangle.front];
      triangle.back = materials[triangle.back];
      result.triangles.push_back(triangle);
    }
  }
  weld(result);
  return result;
}

namespace {

std::string coordinates(const Vec3& p) { return fmt::format("{} {} {}", p.x, p.y, p.z); }

void write_vtp(const std::filesystem::path& path, InterfaceMesh&& mesh, const NamedColours& colours) {
  UnstructuredMesh polygons;
  polygons.kind = CellKind::kPolygons;
  polygons.points = std::move(mesh.points);
  std::vector<std::int32_t> front, back;
  polygons.connectivity.reserve(3 * mesh.triangles.size());
  polygons.offsets.reserve(mesh.triangles.size() + 1);
  front.reserve(mesh.triangles.size()), back.reserve(mesh.triangles.size());
  for (const InterfaceTriangle& t : mesh.triangles) {
    polygons.connectivity.insert(polygons.connectivity.end(), t.points.begin(), t.points.end());
    polygons.offsets.push_back(polygons.connectivity.size());
    front.push_back(static_cast<std::int32_t>(t.front.value));
    back.push_back(static_cast<std::int32_t>(t.back.value));
  }
  release_memory(mesh.triangles);
  polygons.cell_arrays = {{"front", 1, std::move(front)}, {"back", 1, std::move(back)}};
  polygons.field_arrays = {{"material_names", 1, std::vector<std::string>(mesh.materials)}};
  add_colours(mesh.materials, colours, polygons.field_arrays);
  write_unstructured_mesh(path, std::move(polygons));
}

void write_ply(OutputStream& out, const InterfaceMesh& mesh) {
  out.write("ply\nformat binary_little_endian 1.0\n");
  for (const std::string& name : mesh.materials) out.write("comment material " + name + "\n");
  out.write(fmt::format("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
                        mesh.points.size()));
  out.write(
      fmt::format("element face {}\nproperty list uchar int vertex_indices\nproperty int front\n"
                  "property int back\nend_header\n",
                  mesh.triangles.size()));
  for (const Vec3& p : mesh.points) {
    for (int axis = 0; axis < 3; ++axis) out.put(p[axis]);
  }
  for (const InterfaceTriangle& t : mesh.triangles) {
    out.put(static_cast<unsigned char>(3));
    for (const std::uint32_t p : t.points) out.put(static_cast<std::int32_t>(p));
    out.put(static_cast<std::int32_t>(t.front.value));
    out.put(static_cast<std::int32_t>(t.back.value));
  }
}

std::string obj_name(const std::string& name) {
  std::string result = name;
  for (char& c : result) {
    if (c == ' ' || c == '\t' || c == '\n' || c == '\r') c = '_';
  }
  return result;
}

void write_obj(OutputStream& out, const InterfaceMesh& mesh) {
  for (const Vec3& p : mesh.points) out.write("v " + coordinates(p) + "\n");
  std::map<std::pair<MaterialId, MaterialId>, std::vector<const InterfaceTriangle*>> groups;
  for (const InterfaceTriangle& t : mesh.triangles) groups[{t.front, t.back}].push_back(&t);
  for (const auto& [sides, triangles] : groups) {
    out.write("g " + obj_name(mesh.materials[sides.first]) + "|" + obj_name(mesh.materials[sides.second]) +
              "\n");
    for (const InterfaceTriangle* t : triangles) {
      out.write(fmt::format("f {} {} {}\n", t->points[0] + 1, t->points[1] + 1, t->points[2] + 1));
    }
  }
}

void write_off(OutputStream& out, const InterfaceMesh& mesh) {
  out.write(fmt::format("OFF\n{} {} 0\n", mesh.points.size(), mesh.triangles.size()));
  for (const Vec3& p : mesh.points) out.write(coordinates(p) + "\n");
  for (const InterfaceTriangle& t : mesh.triangles) {
    out.write(fmt::format("3 {} {} {}\n", t.points[0], t.points[1], t.points[2]));
  }
}

void write_stl(OutputStream& out, const InterfaceMesh& mesh) {
  std::array<char, 80> header{};
  out.write(header.data(), header.size());
  out.put(static_cast<std::uint32_t>(mesh.triangles.size()));
  const auto put = [&out](const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) out.put(static_cast<float>(v[axis]));
  };
  for (const InterfaceTriangle& t : mesh.triangles) {
    const Vec3 &a = mesh.points[t.points[0]], &b = mesh.points[t.points[1]], &c = mesh.points[t.points[2]];
    put(normalized(cross(b - a, c - a)));
    for (const Vec3* p : {&a, &b, &c}) put(*p);
    out.put(std::uint16_t{0});
  }
}

LabelledNetwork to_network(const InterfaceMesh& mesh) {
  LabelledNetwork network;
  network.points = mesh.points;
  for (const InterfaceTriangle& t : mesh.triangles) {
    network.triangles.push_back(t.points);
    network.labels.push_back(
        {static_cast<std::int32_t>(t.front.value), static_cast<std::int32_t>(t.back.value)});
  }
  return network;
}

/// A reader determines the front from the data (first_label_is_front). If needed, the columns are exchanged
/// or, if two materials leave the front undetermined, the second one is labelled -1.
void write_network(OutputStream& out, const InterfaceMesh& mesh) {
  LabelledNetwork network = to_network(mesh);
  if (!first_label_is_front(network)) {
    for (auto& labels : network.labels) std::swap(labels[0], labels[1]);
    if (first_label_is_front(network)) {
      for (auto& labels : network.labels) {
        std::swap(labels[0], labels[1]);
        for (std::int32_t& label : labels) label = label == 1 ? -1 : label;
      }
    }
  }
  out.write(fmt::format("{}\n", network.points.size()));
  for (const Vec3& p : network.points) out.write(coordinates(p) + "\n");
  out.write(fmt::format("{}\n", network.triangles.size()));
  for (std::size_t t = 0; t < network.triangles.size(); ++t) {
    const auto& [a, b, c] = network.triangles[t];
    out.write(fmt::format("{} {} {} {} {}\n", a, b, c, network.labels[t][0], network.labels[t][1]));
  }
}

}  // namespace

void write_interface_mesh(const std::filesystem::path& path, const InterfaceMesh& mesh) {
  write_interface_mesh(path, InterfaceMesh(mesh));
}

void write_interface_mesh(const std::filesystem::path& path, InterfaceMesh&& mesh,
                          const NamedColours& colours) {
  const std::string extension = file_extension(path);
  if (extension == ".vtp") return write_vtp(path, std::move(mesh), colours);
  using Writer = void (*)(OutputStream&, const InterfaceMesh&);
  const std::map<std::string, Writer> writers{{".ply", write_ply},      {".obj", write_obj},
                                              {".off", write_off},      {".stl", write_stl},
                                              {".arec", write_network}, {".txt", write_network}};
  const auto writer = writers.find(extension);
  if (writer == writers.end()) {
    fail("{}: expected .vtp, .ply, .obj, .off, .stl or .arec for an interface mesh, found '{}'",
         path.string(), extension);
  }
  OutputStream out(path);
  writer->second(out, mesh);
  out.finish();
}

}  // namespace adamas::io
