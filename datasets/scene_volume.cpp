#include "datasets/scene_volume.h"

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace adamas::datasets {

SceneVolume::SceneVolume(const Scene& scene, const std::array<std::size_t, 3>& samples, SampleType type)
    : scene_(scene), scale_(type, -0.25 * shortest_side(scene.box()), 0.25 * shortest_side(scene.box())) {
  const Vec3 size = scene.box().size();
  grid_.type = type;
  grid_.origin = scene.box().min;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t n = samples[static_cast<std::size_t>(axis)];
    if (n < 2) {
      fail("scene {}: expected at least two samples along each axis, found {} x {} x {}", scene.name(),
           samples[0], samples[1], samples[2]);
    }
    grid_.dimensions[static_cast<std::size_t>(axis)] = n;
    grid_.spacing[axis] = size[axis] / static_cast<double>(n - 1);
  }
}

double SceneVolume::value(const Vec3& p) const {
  double greatest = -std::numeric_limits<double>::infinity();
  for (MaterialId m(1); m.value < scene_.materials().size(); ++m.value)
    greatest = std::max(greatest, scene_.value(m, p));
  return greatest - scene_.value(MaterialId(0), p);
}

void SceneVolume::plane(std::uint64_t k, std::span<std::byte> samples) const {
  const auto place = [&](std::uint64_t i, int axis) {
    return grid_.origin[axis] + static_cast<double>(i) * grid_.spacing[axis];
  };
  const auto nx = static_cast<std::size_t>(grid_.dimensions[0]);
  parallel_for(static_cast<std::size_t>(grid_.dimensions[1]), 1, [&](std::size_t j) {
    for (std::size_t i = 0; i < nx; ++i)
      scale_.put(value({place(i, 0), place(j, 1), place(k, 2)}), i + nx * j, samples);
  });
}

}  // namespace adamas::datasets
