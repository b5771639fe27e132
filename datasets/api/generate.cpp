#include "adamas/generate.h"

#include <bit>

#include "adamas/flows.h"
#include "core/base/error.h"
#include "core/data/interface_mesh.h"
#include "core/data/multi_material_data.h"
#include "datasets/buckyball.h"
#include "datasets/scene_interfaces.h"
#include "datasets/scene_sampling.h"
#include "datasets/scene_volume.h"

namespace adamas {

using namespace datasets;

namespace {

constexpr const char* kImpact = "impact";

}  // namespace

struct AnalyticScene::Contents {
  Scene scene;
  std::uint64_t noise_seed = 0;
};

// Each step of a series has noise of its own. At time 1, which all other scenes have, the seed is unchanged.
AnalyticScene::AnalyticScene(std::string_view name, std::uint64_t seed, const SceneOptions& options)
    : contents_(new Contents{make_scene(name, seed, options), seed ^
                                                                  std::bit_cast<std::uint64_t>(options.time) ^
                                                                  std::bit_cast<std::uint64_t>(1.0)}) {}

const std::string& AnalyticScene::name() const { return contents_->scene.name(); }
const Box3& AnalyticScene::box() const { return contents_->scene.box(); }

std::vector<SceneMaterial> AnalyticScene::materials() const {
  const Scene& scene = contents_->scene;
  std::vector<SceneMaterial> result;
  for (MaterialId m(0); m.value < scene.materials().size(); ++m.value)
    result.push_back({scene.materials()[m], scene.volume(m), scene.volume_error(m)});
  return result;
}

GeneratedScene AnalyticScene::sample(const std::array<std::size_t, 3>& cells, const FractionBlur& blur,
                                     Progress& progress) const {
  SamplingOptions options;
  options.blur = blur, options.noise_seed = contents_->noise_seed;
  SceneIntegral integral;
  auto data = std::make_unique<MultiMaterialData>(
      sample_scene(contents_->scene, cells, options, progress, &integral));
  GeneratedScene result{OwnedGridData(std::move(data)), materials()};
  for (MaterialId m(0); m.value < result.materials.size(); ++m.value) {
    result.materials[m.value].sampled_volume = integral.volumes[m];
    result.materials[m.value].sampling_error = integral.errors[m];
  }
  return result;
}

Volume AnalyticScene::samples(const std::array<std::size_t, 3>& dimensions, SampleType type) const {
  const SceneVolume scene(contents_->scene, dimensions, type);
  Volume volume{scene.grid(), std::vector<std::byte>(scene.grid().bytes())};
  const std::size_t plane = volume.grid.plane_bytes();
  for (std::uint64_t k = 0; k < dimensions[2]; ++k)
    scene.plane(k, std::span(volume.samples).subspan(k * plane, plane));
  volume.grid.slope = scene.scale().slope(), volume.grid.intercept = scene.scale().intercept();
  return volume;
}

InterfaceTriangles AnalyticScene::interfaces(double resolution, Progress& progress) const {
  return to_interface_triangles(scene_interfaces(contents_->scene, resolution, progress));
}

GeneratedScene generate_scene(std::string_view name, const std::array<std::size_t, 3>& cells,
                              std::uint64_t seed, Progress& progress) {
  return AnalyticScene(name, seed).sample(cells, {}, progress);
}

GeneratedScene generate_scene(std::string_view name, const std::array<std::size_t, 3>& cells,
                              const FractionBlur& blur, std::uint64_t seed, Progress& progress) {
  return AnalyticScene(name, seed).sample(cells, blur, progress);
}

void GeneratedData::check() const {
  if (name == kImpact) {
    if (seed) wrong_usage("--seed: expected a scene to generate, found the impact");
  } else if (!cells) {
    wrong_usage("--generate {}: expected --dimensions X,Y,Z as well", name);
  }
}

std::vector<std::string> generated_names() {
  std::vector<std::string> names = scene_names();
  names.insert(names.begin(), kImpact);
  return names;
}

OwnedGridData generate_data(const GeneratedData& data, Progress& progress) {
  data.check();
  if (data.name != kImpact)
    return AnalyticScene(data.name, data.seed.value_or(0)).sample(*data.cells, {}, progress).data;
  ImpactOptions options;
  if (data.cells) options.cells = *data.cells;
  ImpactSimulation flow(options);
  flow.advance_to(kImpactTime, progress);
  return flow.data();
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
