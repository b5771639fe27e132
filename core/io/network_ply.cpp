#include "core/io/network_ply.h"

#include <cstdint>
#include <cstdio>
#include <optional>
#include <sstream>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/ply_file.h"

namespace adamas::io {

namespace {

constexpr std::size_t kPointBytes = 3 * sizeof(double);
constexpr std::size_t kFaceBytes = 1 + 5 * sizeof(std::int32_t);

bool has_sides(const std::string& header) {
  return header.find("\nproperty int front\nproperty int back\n") != std::string::npos;
}

struct Counts {
  std::size_t points = 0, faces = 0;
  std::vector<std::string> materials;
};

/// The counts in a header that this program has written; empty for other headers.
std::optional<Counts> parse(const std::string& header) {
  Counts counts;
  std::istringstream lines(header);
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const std::string material = "comment material ";
    if (line.rfind(material, 0) == 0) {
      counts.materials.push_back(line.substr(material.size()));
      continue;
    }
    unsigned long long number = 0;
    if (std::sscanf(line.c_str(), "element vertex %llu", &number) == 1) {
      counts.points = number;
      line = "element vertex";
    } else if (std::sscanf(line.c_str(), "element face %llu", &number) == 1) {
      counts.faces = number;
      line = "element face";
    }
    text += line + "\n";
  }
  const bool ours = text ==
                    "ply\nformat binary_little_endian 1.0\nelement vertex\nproperty double x\nproperty "
                    "double y\nproperty double "
                    "z\nelement face\nproperty list uchar int vertex_indices\nproperty int front\nproperty "
                    "int back\nend_header\n";
  return ours ? std::optional(std::move(counts)) : std::nullopt;
}

}  // namespace

bool is_network_ply(const std::filesystem::path& path) {
  return file_extension(path) == ".ply" && has_sides(ply_header_of(path));
}

InterfaceMesh read_network_ply(const std::filesystem::path& path) {
  return parse_network_ply(read_file(path), path.string());
}

InterfaceMesh parse_network_ply(const std::string& bytes, const std::string& name) {
  const std::string header = ply_header(bytes);
  const auto counts = parse(header);
  if (!counts)
    fail(
        "{}: expected a network as adamas writes it (binary, double coordinates, front and back), found "
        "another "
        "PLY",
        name);
  check_ply_bytes({counts->points, kPointBytes, counts->faces, kFaceBytes}, bytes.size() - header.size(),
                  name);
  InterfaceMesh mesh;
  mesh.source = name;
  mesh.materials.assign(counts->materials.begin(), counts->materials.end());
  ByteCursor cursor(bytes.data() + header.size());
  for (std::size_t i = 0; i < counts->points; ++i) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = cursor.take<double>();
    if (!is_finite(p)) fail("{}: point {}: expected finite coordinates, found others", name, i);
    mesh.points.push_back(p);
  }
  const auto index = [&](std::size_t end, const char* what) {
    const auto value = cursor.take<std::int32_t>();
    if (value < 0 || static_cast<std::size_t>(value) >= end)
      fail("{}: expected a {} below {}, found {}", name, what, end, value);
    return static_cast<std::uint32_t>(value);
  };
  for (std::size_t i = 0; i < counts->faces; ++i) {
    if (const auto corners = cursor.take<std::uint8_t>(); corners != 3)
      fail("{}: face {}: expected a triangle, found {} corners", name, i, corners);
    InterfaceTriangle triangle{};
    for (std::uint32_t& p : triangle.points) p = index(mesh.points.size(), "point");
    triangle.front = MaterialId(index(mesh.materials.size(), "material"));
    triangle.back = MaterialId(index(mesh.materials.size(), "material"));
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace adamas::io
