#include "core/io/surface_ply.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/base/error.h"
#include "core/io/header_text.h"
#include "core/io/input_file.h"

namespace adamas::io {

namespace {

constexpr const char* kEnd = "end_header\n";
constexpr const char* kValue = "comment value is ";
constexpr std::size_t kFaceBytes = 1 + 3 * sizeof(std::uint32_t);

/// Returns the figures of a header that SurfacePly::header() gives at the beginning of these bytes; none for
/// other headers.
std::optional<SurfacePly> parse_header(const std::string& beginning) {
  const std::size_t end = beginning.find(kEnd);
  if (end == std::string::npos) return {};
  const std::string text = beginning.substr(0, end + std::strlen(kEnd));
  SurfacePly found;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    unsigned long long number = 0;
    if (line.starts_with(kValue)) {
      found.value_name = line.substr(std::strlen(kValue));
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

/// Takes numbers from the bytes of a file, one after another; there must be enough.
class ByteCursor {
 public:
  explicit ByteCursor(const char* at) : at_(at) {}
  template <class T>
  T take() {
    T value;
    std::memcpy(&value, at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  template <class T>
  Vec3 take_vector() {
    const auto x = static_cast<double>(take<T>()), y = static_cast<double>(take<T>());
    return {x, y, static_cast<double>(take<T>())};
  }

 private:
  const char* at_;
};

}  // namespace

std::size_t SurfacePly::point_bytes() const {
  return 3 * (single ? sizeof(float) : sizeof(double)) + (normals ? 3 * sizeof(float) : 0) +
         (value_name ? sizeof(float) : 0);
}

std::string SurfacePly::header() const {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment adamas\n";
  if (value_name) text += kValue + printable(*value_name, 200) + "\n";
  text += fmt::format("element vertex {}\n", points);
  for (const char axis : {'x', 'y', 'z'})
    text += fmt::format("property {} {}\n", single ? "float" : "double", axis);
  if (normals) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (value_name) text += "property float value\n";
  text += fmt::format("element face {}\nproperty list uchar uint vertex_indices\n", triangles);
  return text + kEnd;
}

bool is_surface_ply(const std::filesystem::path& path) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) return false;
  std::ifstream stream(path, std::ios::binary);
  std::string beginning(kLongestHeader, '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  return parse_header(beginning).has_value();
}

TriangleSurface parse_surface_ply(const std::string& bytes, const std::string& name) {
  const auto layout = parse_header(bytes);
  if (!layout) fail("{}: expected a surface as adamas writes it, found another PLY", name);
  const std::size_t header = layout->header().size(), rest = bytes.size() - header;
  if (layout->points > rest / layout->point_bytes() || layout->triangles > rest / kFaceBytes ||
      layout->points * layout->point_bytes() + layout->triangles * kFaceBytes != rest)
    fail("{}: expected {} points and {} triangles, found {} bytes for them", name, layout->points,
         layout->triangles, rest);
  TriangleSurface surface;
  if (layout->value_name) surface.value_name = *layout->value_name;
  ByteCursor cursor(bytes.data() + header);
  for (std::size_t i = 0; i < layout->points; ++i) {
    surface.points.push_back(layout->single ? cursor.take_vector<float>() : cursor.take_vector<double>());
    if (layout->normals) surface.normals.push_back(cursor.take_vector<float>());
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
