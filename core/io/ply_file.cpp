#include "core/io/ply_file.h"

#include <fstream>
#include <string_view>

#include "core/base/error.h"
#include "core/io/input_file.h"

namespace adamas::io {

std::string ply_header(const std::string& beginning) {
  constexpr std::string_view kEnd = "end_header\n";
  if (!beginning.starts_with("ply\n")) return "";
  const std::size_t end = beginning.find(kEnd);
  return end == std::string::npos ? "" : beginning.substr(0, end + kEnd.size());
}

std::string ply_header_of(const std::filesystem::path& path) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) return "";
  std::ifstream stream(path, std::ios::binary);
  std::string beginning(kLongestHeader, '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  return ply_header(beginning);
}

void check_ply_bytes(const PlyElements& elements, std::size_t bytes, const std::string& name) {
  const auto [points, point_bytes, faces, face_bytes] = elements;
  if (points > bytes / point_bytes || faces > bytes / face_bytes ||
      points * point_bytes + faces * face_bytes != bytes)
    fail("{}: expected {} points and {} triangles, found {} bytes for them", name, points, faces, bytes);
}

}  // namespace adamas::io
