#include "cli/generated_data.h"

#include "cli/option_values.h"
#include "cli/usage.h"
#include "datasets/flow/impact.h"
#include "datasets/scene.h"
#include "datasets/scene_sampling.h"

namespace adamas::cli {

using namespace datasets;

namespace {

constexpr const char* kImpact = "impact";

}  // namespace

std::vector<std::string> generated_names() {
  std::vector<std::string> names = scene_names();
  names.insert(names.begin(), kImpact);
  return names;
}

GeneratedData parse_generated_data(const std::string& name, const std::string& dimensions,
                                   const std::string& seed) {
  GeneratedData result{.name = name};
  if (name == kImpact) {
    result.cells = ImpactOptions().cells;
    if (!seed.empty()) wrong_usage("--seed: expected a scene to generate, found the impact");
  } else if (dimensions.empty()) {
    wrong_usage("--generate {}: expected --dimensions X,Y,Z as well", name);
  }
  if (!dimensions.empty()) result.cells = parse_dimensions("--dimensions", dimensions);
  if (!seed.empty()) result.seed = parse_count("--seed", seed, 0);
  return result;
}

MultiMaterialData generate_data(const GeneratedData& what, Progress& progress) {
  if (what.name != kImpact) return sample_scene(make_scene(what.name, what.seed), what.cells, {}, progress);
  ImpactOptions options;
  options.cells = what.cells;
  FlowSolver<3> flow = make_impact(options);
  flow.advance_to(kImpactTime, progress);
  return flow_data(flow, kImpact, kImpactUnits);
}

}  // namespace adamas::cli
