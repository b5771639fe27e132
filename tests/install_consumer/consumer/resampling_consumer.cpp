// Resamples a small analytic scene and checks the volume of the sphere in it.

#include <cmath>
#include <cstdio>

#include "core/picture/palette.h"
#include "datasets/scene_sampling.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/resampling/output.h"
#include "interfaces/resampling/resampler.h"
#include "interfaces/source/grid_source.h"

int main() {
  const adamas::Scene scene = adamas::make_scene("sphere");
  const adamas::MultiMaterialData data = adamas::sample_scene(scene, {12, 12, 12});
  const adamas::ResamplingSource source = adamas::make_grid_source(data);
  adamas::ResamplingOptions options;
  options.interface_error = 0.02;
  adamas::Resampler resampler(source, options);
  resampler.refine();
  const adamas::ResampledMesh mesh = adamas::resampled_mesh(resampler);
  const auto volumes = adamas::body_volumes(mesh.table, mesh.cell_set());
  double worst = 0;
  for (std::size_t m = 0; m < scene.materials().size(); ++m) {
    const adamas::MaterialId material(m);
    double volume = 0;
    for (std::size_t b = 0; b < volumes.size(); ++b) {
      if (mesh.table.material(adamas::BodyId(b)) == material) volume += volumes[adamas::BodyId(b)];
    }
    worst = std::max(worst, std::abs(volume - scene.volume(material)));
  }
  std::printf("%zu tetrahedra, volumes off by at most %.4f, %zu colours\n", mesh.cells.size(), worst,
              adamas::kPaletteSize);
  return worst < 0.05 && adamas::to_unstructured_mesh(mesh).cell_count() == mesh.cells.size() ? 0 : 1;
}
