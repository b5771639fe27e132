// Writes a volume and a network of interfaces, and reads them back.

#include <adamas/files.h>

#include <cstdio>
#include <filesystem>

int main() {
  // The reader program lies neither beside this program nor where it was to be installed.
  adamas::set_reader_program(READER_PROGRAM);
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "adamas_consumer_io";
  std::filesystem::create_directories(folder);

  const std::vector<std::uint16_t> samples{1, 2, 3, 4, 5, 6, 7, 8};
  adamas::VolumeGrid grid;
  grid.dimensions = {2, 2, 2};
  grid.type = adamas::SampleType::kUint16;
  adamas::write_volume(folder / "volume.nrrd", grid, std::as_bytes(std::span(samples)));
  const adamas::Volume volume = adamas::read_volume(folder / "volume.nrrd");

  adamas::InterfaceTriangles triangle;
  triangle.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.triangles = {{0, 1, 2}};
  triangle.sides = {{0, 1}};
  triangle.materials = {"air", "water"};
  adamas::write_mesh(folder / "interfaces.vtp", triangle);
  const adamas::InterfaceTriangles read = adamas::read_interfaces(folder / "interfaces.vtp");
  std::filesystem::remove_all(folder);

  std::printf("%zu samples, %zu triangle\n", volume.as<std::uint16_t>().size(), read.triangles.size());
  const bool same = volume.as<std::uint16_t>()[7] == 8 && read.points == triangle.points;
  return same && read.triangles.size() == 1 && read.materials[read.sides[0][0]] == "air" ? 0 : 1;
}
