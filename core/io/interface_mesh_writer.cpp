#include <fmt/format.h>

#include <map>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/network_text.h"
#include "core/io/output_stream.h"
#include "core/io/unstructured_mesh_io.h"

namespace adamas::io {

namespace {

std::string coordinates(const Vec3& p) { return fmt::format("{} {} {}", p.x, p.y, p.z); }

void write_vtp(const std::filesystem::path& path, const InterfaceMesh& mesh) {
  UnstructuredMesh polygons;
  polygons.kind = CellKind::kPolygons;
  polygons.points = mesh.points;
  std::vector<std::int32_t> front, back;
  for (const InterfaceTriangle& t : mesh.triangles) {
    polygons.connectivity.insert(polygons.connectivity.end(), t.points.begin(), t.points.end());
    polygons.offsets.push_back(polygons.connectivity.size());
    front.push_back(static_cast<std::int32_t>(t.front.value));
    back.push_back(static_cast<std::int32_t>(t.back.value));
  }
  polygons.cell_arrays = {{"front", 1, std::move(front)}, {"back", 1, std::move(back)}};
  polygons.field_arrays = {{"material_names", 1, std::vector<std::string>(mesh.materials)}};
  write_unstructured_mesh(path, polygons);
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

/// A reader works out the front from the data (first_label_is_front): either the columns change places or,
/// where two materials leave it open, the second is labelled -1.
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
  const std::string extension = file_extension(path);
  if (extension == ".vtp") return write_vtp(path, mesh);
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
