// Generates a scene of several materials, and checks the volumes on its grid against the true ones.

#include <adamas/generate.h>

#include <cmath>
#include <cstdio>

int main() {
  const adamas::GeneratedScene scene = adamas::generate_scene("voronoi10", {12, 12, 12}, 3);
  const adamas::GridData data = scene.data.view();
  const std::vector<double> volumes = adamas::material_volumes(data);
  double worst = 0;
  for (std::size_t m = 0; m < volumes.size(); ++m)
    worst = std::max(worst, std::abs(volumes[m] - scene.materials[m].volume));
  const adamas::Volume ball = adamas::generate_buckyball({20, 20, 20});
  std::printf("%zu materials, volumes off by at most %.2g; %zu samples\n", volumes.size(), worst,
              ball.as<std::uint8_t>().size());
  return volumes.size() == 10 && worst < 1e-5 && ball.as<std::uint8_t>().size() == 8000 ? 0 : 1;
}
