#include "adamas/generate.h"

#include "core/data/multi_material_data.h"
#include "datasets/buckyball.h"
#include "datasets/scene_sampling.h"

namespace adamas {

using namespace datasets;

GeneratedScene generate_scene(std::string_view name, const std::array<std::size_t, 3>& cells,
                              std::uint64_t seed, Progress& progress) {
  return generate_scene(name, cells, FractionBlur{}, seed, progress);
}

GeneratedScene generate_scene(std::string_view name, const std::array<std::size_t, 3>& cells,
                              const FractionBlur& blur, std::uint64_t seed, Progress& progress) {
  const Scene scene = make_scene(name, seed);
  SamplingOptions options;
  options.blur = blur, options.noise_seed = seed;
  auto data = std::make_unique<MultiMaterialData>(sample_scene(scene, cells, options, progress));
  GeneratedScene result{OwnedGridData(std::move(data)), {}};
  for (MaterialId m(0); m.value < scene.materials().size(); ++m.value)
    result.volumes.push_back(scene.volume(m));
  return result;
}

Volume generate_buckyball(const std::array<std::uint64_t, 3>& samples, SampleType type) {
  const Buckyball ball(samples, type);
  Volume volume{ball.grid(), std::vector<std::byte>(ball.grid().bytes())};
  const std::size_t plane = volume.grid.plane_bytes();
  for (std::uint64_t k = 0; k < samples[2]; ++k)
    ball.plane(k, std::span(volume.samples).subspan(k * plane, plane));
  return volume;
}

}  // namespace adamas
