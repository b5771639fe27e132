// Describes data of two materials in arrays of its own, and asks for the volumes of the materials.

#include <adamas/error.h>
#include <adamas/grid_data.h>

#include <cmath>
#include <cstdio>

int main() {
  // Water fills the lower half of a box of 2 x 2 x 1 cells.
  const std::vector<float> water{1, 1, 0, 0}, air{0, 0, 1, 1};
  adamas::GridData data;
  data.grid = adamas::RectilinearGrid::uniform({2, 2, 1}, {0, 0, 0}, {0.5, 0.5, 1});
  data.materials = {"water", "air"};
  data.fractions = {water, air};
  const std::vector<double> volumes = adamas::material_volumes(data);
  std::printf("%s %.3f, %s %.3f\n", data.materials[0].c_str(), volumes[0], data.materials[1].c_str(),
              volumes[1]);

  data.fractions.pop_back();
  try {
    adamas::check(data);
    return 1;
  } catch (const adamas::Error& error) {
    std::printf("%s\n", error.what());
  }
  return std::abs(volumes[0] - 0.5) < 1e-12 && std::abs(volumes[1] - 0.5) < 1e-12 ? 0 : 1;
}
