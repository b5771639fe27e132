// Makes a store of samples in memory, and takes a surface and a coarse part of the samples back out of it.

#include <adamas/volume_store.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

int main() {
  // The samples are distances from the middle of a box, at 48 x 48 x 48 points.
  constexpr std::size_t kSamples = 48;
  std::vector<float> distances;
  for (std::size_t s = 0; s < kSamples * kSamples * kSamples; ++s) {
    const auto at = [](std::size_t i) { return static_cast<double>(i) - (kSamples - 1) / 2.0; };
    const adamas::Vec3 offset{at(s % kSamples), at(s / kSamples % kSamples), at(s / kSamples / kSamples)};
    distances.push_back(static_cast<float>(adamas::norm(offset)));
  }
  adamas::VolumeGrid grid;
  grid.dimensions = {kSamples, kSamples, kSamples};
  grid.type = adamas::SampleType::kFloat32;

  const std::filesystem::path path = std::filesystem::temp_directory_path() / "adamas_consumer.adm";
  adamas::VolumeStore::build(path, grid, std::as_bytes(std::span(distances)));

  adamas::VolumeStore store = adamas::VolumeStore::open(path);
  const adamas::Isosurface sphere = store.isosurface({.isovalue = 15, .error = 0.1});
  double farthest = 0;
  for (const adamas::Vec3& p : sphere.surface.points) {
    const adamas::Vec3 middle{(kSamples - 1) / 2.0, (kSamples - 1) / 2.0, (kSamples - 1) / 2.0};
    farthest = std::max(farthest, std::abs(adamas::norm(p - middle) - 15));
  }
  std::printf("%zu triangles, %.3f from the sphere at most, error %.3f\n", sphere.surface.triangles.size(),
              farthest, sphere.max_error);

  // Every second sample of a part.
  const adamas::Volume part = store.restore({adamas::Box3{{0, 0, 0}, {10, 10, 10}}, 1});
  const bool same = part.as<float>()[1] == distances[2];
  std::printf("%zu x %zu x %zu samples of LOD 1\n", std::size_t{part.grid.dimensions[0]},
              std::size_t{part.grid.dimensions[1]}, std::size_t{part.grid.dimensions[2]});
  std::filesystem::remove(path);
  return same && farthest < 0.5 && sphere.max_error <= 0.1 ? 0 : 1;
}
