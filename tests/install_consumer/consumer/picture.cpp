// Draws a slice of two polygons.

#include <adamas/picture.h>

#include <cstdio>
#include <filesystem>

int main() {
  adamas::Slice slice;
  slice.plane = {{0, 0, 0}, {0, 0, 1}};
  slice.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
  slice.offsets = {0, 4, 8};
  slice.polygon_materials = {0, 1};
  slice.materials = {"water", "air"};
  slice.interface_edges = {{{{1, 0, 0}, {1, 1, 0}}}};
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "adamas_consumer.png";
  adamas::write_picture(path, slice, {.width = 400, .height = 300});
  const auto bytes = std::filesystem::file_size(path);
  std::filesystem::remove(path);
  std::printf("%ju bytes\n", std::uintmax_t{bytes});
  return bytes > 1000 ? 0 : 1;
}
