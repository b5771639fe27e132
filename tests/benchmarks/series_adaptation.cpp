// Measures what adapting the mesh of the last step costs beside refinement from the roots: processor seconds
// for the same meshes, step by step, in alternation.
//   bench_series_adaptation [CELLS [STEPS [ERROR%]]]

#include <fmt/format.h>

#include <cstdlib>
#include <ctime>
#include <optional>
#include <vector>

#include "datasets/flow/impact.h"
#include "datasets/scene.h"
#include "datasets/scene_sampling.h"
#include "interfaces/input/grid_source.h"
#include "interfaces/resampling/resampler.h"

using namespace adamas;
using namespace adamas::datasets;
using namespace adamas::interfaces;

namespace {

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Refines, from another hierarchy or from the roots. Returns processor seconds.
double refine(Resampler& resampler, std::optional<Resampler::MeshHierarchy> from) {
  const double before = seconds();
  if (from) {
    resampler.refine(std::move(*from));
  } else {
    resampler.refine();
  }
  return seconds() - before;
}

void measure(const char* name, const std::vector<MultiMaterialData>& steps, double error, bool certify) {
  fmt::print("{}, {}\n  step  tetrahedra   kept  merged   split  from the roots  adapted  ratio\n", name,
             certify ? "certified" : "by estimates alone");
  std::optional<Resampler::MeshHierarchy> previous;
  double all_alone = 0, all_adapted = 0;
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const ResamplingSource source = make_grid_source(steps[n]);
    ResamplingOptions options;
    options.interface_error = error * source.box.diagonal();
    options.certify = certify;
    Resampler alone(source, options), adapted(source, options);
    const double seconds_alone = refine(alone, {}),
                 seconds_adapted = refine(adapted, std::exchange(previous, {}));
    if (const auto& changes = adapted.adaptation()) {
      fmt::print("  {:4}  {:10}  {:5}  {:6}  {:6}  {:14.3f}  {:7.3f}  {:5.2f}\n", n,
                 adapted.hierarchy().leaf_count(), changes->kept, changes->merged, changes->split,
                 seconds_alone, seconds_adapted, seconds_adapted / seconds_alone);
      all_alone += seconds_alone;
      all_adapted += seconds_adapted;
    }
    previous = adapted.give_hierarchy();
  }
  fmt::print("  all from step 1 on: {:.3f} s from the roots, {:.3f} s adapted, ratio {:.3f}\n\n", all_alone,
             all_adapted, all_adapted / all_alone);
}

std::vector<MultiMaterialData> moving(std::size_t cells, std::size_t count) {
  std::vector<MultiMaterialData> steps;
  for (std::size_t n = 0; n < count; ++n) {
    SceneOptions scene;
    scene.time = static_cast<double>(n) / static_cast<double>(count - 1);
    SamplingOptions sampling;
    sampling.fields = false;
    steps.push_back(sample_scene(make_scene("moving", 0, scene), {cells, cells, cells}, sampling));
  }
  return steps;
}

std::vector<MultiMaterialData> impact(std::size_t cells, std::size_t count) {
  ImpactOptions options;
  options.cells = {cells, cells, cells};
  FlowSolver<3> flow = make_impact(options);
  std::vector<MultiMaterialData> steps;
  for (std::size_t n = 0; n < count; ++n) {
    flow.advance_to(kImpactTime * static_cast<double>(n) / static_cast<double>(count - 1),
                    SilentProgress::instance());
    steps.push_back(flow_data(flow, "impact", kImpactUnits));
    steps.back().fields.clear();
  }
  return steps;
}

}  // namespace

int main(int count, char** arguments) {
  const auto argument = [&](int i, double otherwise) {
    return count > i ? std::atof(arguments[i]) : otherwise;
  };
  const auto cells = static_cast<std::size_t>(argument(1, 24)),
             steps = static_cast<std::size_t>(argument(2, 11));
  const double error = argument(3, 1) / 100;
  const auto scene = moving(cells, steps), flow = impact(cells, steps);
  for (const bool certify : {false, true}) {
    measure("moving scene", scene, error, certify);
    measure("impact", flow, error, certify);
  }
  return 0;
}
