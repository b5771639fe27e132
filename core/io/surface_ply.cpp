#include "core/io/surface_ply.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <sstream>
#include <string_view>

#include "core/base/error.h"
#include "core/io/header_text.h"
#include "core/io/ply_file.h"

namespace adamas::io {

namespace {

constexpr std::string_view kValue = "comment value is ";
constexpr std::size_t kFaceBytes = 1 + 3 * sizeof(std::uint32_t);

/// Returns the figures of a header that SurfacePly::header() gives; none for other headers.
std::optional<SurfacePly> parse_header(const std::string& text) {
  SurfacePly found;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    unsigned long long number = 0;
    if (line.starts_with(kValue)) {
      found.value_name = line.substr(kValue.size());
    } else if (std::sscanf(line.c_str(), "element vertex %llu", &number) == 1) {
      found.points = number;
    } else if (std::sscanf(line.c_str(), "element face %llu", &number) == 1) {
      found.triangles = number;
    } else if (line == "property double x") {
      found.single = false;
    } else if (line == "property float nx") {
      found.normals = true;
    }
  }
  return found.header() == text ? std::optional(std::move(found)) : std::nullopt;
}

template <class T>
Vec3 take_vector(ByteCursor& cursor) {
  const auto x = static_cast<double>(cursor.take<T>()), y = static_cast<double>(cursor.take<T>());
  return {x, y, static_cast<double>(cursor.take<T>())};
}

}  // namespace

std::size_t SurfacePly::point_bytes() const {
  return 3 * (single ? sizeof(float) : sizeof(double)) + (normals ? 3 * sizeof(float) : 0) +
         (value_name ? sizeof(float) : 0);
}

std::string SurfacePly::header() const {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment adamas\n";
  if (value_name) text += fmt::format("{}{}\n", kValue, printable(*value_name, 200));
  text += fmt::format("element vertex {}\n", points);
  for (const char axis : {'x', 'y', 'z'})
    text += fmt::format("property {} {}\n", single ? "float" : "double", axis);
  if (normals) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (value_name) text += "property float value\n";
  text += fmt::format("element face {}\nproperty list uchar uint vertex_indices\nend_header\n", triangles);
  return text;
}

bool is_surface_ply(const std::filesystem::path& path) {
  return parse_header(ply_header_of(path)).has_value();
}

TriangleSurface parse_surface_ply(const std::string& bytes, const std::string& name) {
  const std::string header = ply_header(bytes);
  const auto layout = parse_header(header);
  if (!layout) fail("{}: expected a surface as adamas writes it, found another PLY", name);
  check_ply_bytes({layout->points, layout->point_bytes(), layout->triangles, kFaceBytes},
                  bytes.size() - header.size(), name);
  TriangleSurface surface;
  if (layout->value_name) surface.value_name = *layout->value_name;
  ByteCursor cursor(bytes.data() + header.size());
  for (std::size_t i = 0; i < layout->points; ++i) {
    surface.points.push_back(layout->single ? take_vector<float>(cursor) : take_vector<double>(cursor));
    if (layout->normals) surface.normals.push_back(take_vector<float>(cursor));
    if (layout->value_name) surface.values.push_back(cursor.take<float>());
  }
  for (std::size_t t = 0; t < layout->triangles; ++t) {
    if (const auto corners = cursor.take<std::uint8_t>(); corners != 3)
      fail("{}: face {}: expected a triangle, found {} corners", name, t, corners);
    surface.triangles.push_back(cursor.take<std::array<std::uint32_t, 3>>());
  }
  surface.check(name);
  return surface;
}

}  // namespace adamas::io
