// Measures the selection of meshes from a saved hierarchy: tetrahedra that splits and merges make and remove
// in a second, including the list of cells, on one thread. Prints a line of JSON.

#include "interfaces/selection/selection.h"

#include <chrono>
#include <cstdio>
#include <string_view>

#include "core/base/parallel.h"
#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "interfaces/input/grid_source.h"
#include "interfaces/resampling/resampler.h"

int main(int argc, char** argv) {
  using namespace adamas;
  using namespace adamas::datasets;
  using namespace adamas::interfaces;
  using Clock = std::chrono::steady_clock;
  const bool quick = argc > 1 && std::string_view(argv[1]) == "--quick";
  const Scene scene = make_scene("sphere");
  const InterfaceMesh mesh = scene_interfaces(scene, 1.0 / 96);
  const ResamplingSource source = make_mesh_source(mesh, scene.box(), nullptr);
  ResamplingOptions options;
  options.certify = false;
  options.interface_error = quick ? 2e-4 : 5e-5;
  Resampler resampler(source, options);
  resampler.refine();
  const SavedHierarchy hierarchy = take_hierarchy(resampler);
  Selection selection(hierarchy);
  std::size_t changed = 0, cells = 0;
  const auto start = Clock::now();
  double seconds = 0;
  for (int i = 0; seconds < 1; ++i) {
    SelectionTargets targets;
    targets.interface_error = options.interface_error * (i % 2 == 0 ? 1.0 : 16.0);
    selection.select(targets);
    cells += selection.cells().size();
    changed += selection.changed();
    seconds = std::chrono::duration<double>(Clock::now() - start).count();
  }
  std::printf("{\"tetrahedra\": %zu, \"changed_per_second\": %.6g, \"listed_per_second\": %.6g}\n",
              hierarchy.tree.cells.size(), static_cast<double>(changed) / seconds,
              static_cast<double>(cells) / seconds);
  return 0;
}
