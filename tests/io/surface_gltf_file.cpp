// Reads the glTF that the project writes, by the specification of the format.

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/io/surface_files.h"
#include "tests/support/scratch.h"

namespace adamas::test {

namespace {

using Json = nlohmann::json;

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  if (at + sizeof(word) > bytes.size()) throw std::runtime_error("a file that is too short");
  std::memcpy(&word, bytes.data() + at, sizeof(word));
  return word;
}

struct Document {
  Json json;
  std::string buffer;
};

Document open_glb(const std::string& bytes) {
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word_at(bytes, 4), 2u);
  EXPECT_EQ(word_at(bytes, 8), bytes.size());
  EXPECT_EQ(bytes.size() % 4, 0u);
  const std::size_t length = word_at(bytes, 12);
  EXPECT_EQ(length % 4, 0u);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  Document document{Json::parse(bytes.substr(20, length)), {}};
  const std::size_t binary = 20 + length;
  if (binary == bytes.size()) return document;
  EXPECT_EQ(bytes.substr(binary + 4, 4), std::string("BIN\0", 4));
  EXPECT_EQ(binary + 8 + word_at(bytes, binary), bytes.size());
  document.buffer = bytes.substr(binary + 8);
  return document;
}

std::string decoded_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  EXPECT_EQ(text.size() % 4, 0u);
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text.substr(0, text.find('='))) {
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 255);
  }
  return bytes;
}

Document open_gltf(const std::string& bytes) {
  Document document{Json::parse(bytes), {}};
  if (!document.json.contains("buffers")) return document;
  const std::string uri = document.json["buffers"][0]["uri"];
  const std::string begin = "data:application/octet-stream;base64,";
  EXPECT_TRUE(uri.starts_with(begin));
  document.buffer = decoded_base64(uri.substr(begin.size()));
  return document;
}

/// Returns the numbers of an accessor with a type of four bytes.
template <class T>
std::vector<T> numbers(const Document& document, const Json& index, int component_type,
                       const std::string& type, int target) {
  const Json& accessor = document.json["accessors"].at(index.get<std::size_t>());
  EXPECT_EQ(accessor["componentType"], component_type);
  EXPECT_EQ(accessor["type"], type);
  const Json& view = document.json["bufferViews"].at(accessor["bufferView"].get<std::size_t>());
  EXPECT_EQ(view["target"], target);
  const std::size_t offset = view["byteOffset"], length = view["byteLength"];
  const std::size_t count = accessor["count"].get<std::size_t>() * (type == "VEC3" ? 3 : 1);
  EXPECT_EQ(offset % sizeof(T), 0u);
  EXPECT_EQ(count * sizeof(T), length);
  EXPECT_GT(length, 0u);
  if (offset + length > document.buffer.size()) throw std::runtime_error("a view beyond the buffer");
  std::vector<T> result(count);
  std::memcpy(result.data(), document.buffer.data() + offset, length);
  return result;
}

void expect_bounds(const Json& accessor, const std::vector<float>& positions) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float least = positions[axis], greatest = positions[axis];
    for (std::size_t i = axis; i < positions.size(); i += 3) {
      least = std::min(least, positions[i]);
      greatest = std::max(greatest, positions[i]);
    }
    EXPECT_EQ(accessor["min"][axis].get<double>(), double{least});
    EXPECT_EQ(accessor["max"][axis].get<double>(), double{greatest});
  }
}

std::vector<Vec3> vectors(const std::vector<float>& numbers, const Vec3& translation) {
  std::vector<Vec3> result;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    result.push_back(translation + Vec3{numbers[i], numbers[i + 1], numbers[i + 2]});
  }
  return result;
}

SurfaceFile surface_of(const Document& document) {
  SurfaceFile file;
  file.single = true;
  const Json& json = document.json;
  EXPECT_EQ(json["asset"]["version"], "2.0");
  const Json& scene = json["scenes"].at(json["scene"].get<std::size_t>());
  if (!scene.contains("nodes")) return file;
  EXPECT_EQ(json["buffers"][0]["byteLength"], document.buffer.size());
  const Json& node = json["nodes"].at(scene["nodes"][0].get<std::size_t>());
  if (node.contains("translation")) {
    const Json& t = node["translation"];
    file.translation = {t[0], t[1], t[2]};
  }
  const Json& primitive = json["meshes"].at(node["mesh"].get<std::size_t>())["primitives"].at(0);
  EXPECT_EQ(json["materials"].at(primitive["material"].get<std::size_t>())["doubleSided"], true);
  const Json& attributes = primitive["attributes"];
  const auto positions = numbers<float>(document, attributes["POSITION"], 5126, "VEC3", 34962);
  expect_bounds(json["accessors"][attributes["POSITION"].get<std::size_t>()], positions);
  file.surface.points = vectors(positions, file.translation);
  if (attributes.contains("NORMAL")) {
    file.surface.normals = vectors(numbers<float>(document, attributes["NORMAL"], 5126, "VEC3", 34962), {});
    for (const Vec3& n : file.surface.normals) EXPECT_NEAR(norm(n), 1, 1e-6);
  }
  if (attributes.contains("_VALUE")) {
    file.surface.values = numbers<float>(document, attributes["_VALUE"], 5126, "SCALAR", 34962);
  }
  const auto corners = numbers<std::uint32_t>(document, primitive["indices"], 5125, "SCALAR", 34963);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    file.surface.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  }
  return file;
}

}  // namespace

SurfaceFile read_gltf_surface(const std::filesystem::path& path) {
  const std::string bytes = bytes_of(path);
  return surface_of(path.extension() == ".glb" ? open_glb(bytes) : open_gltf(bytes));
}

}  // namespace adamas::test
