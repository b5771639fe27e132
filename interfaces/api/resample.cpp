#include "adamas/resample.h"

#include <optional>
#include <utility>

#include "core/base/loop_progress.h"
#include "interfaces/api/adaptive_mesh.h"
#include "interfaces/api/input.h"
#include "interfaces/api/resample_options.h"
#include "interfaces/api/resample_report.h"
#include "interfaces/resampling/resampler.h"

namespace adamas {

using namespace interfaces;

namespace {

/// Moves the hierarchy out of a mesh, which becomes unusable.
std::optional<Resampler::MeshHierarchy> take_hierarchy(AdaptiveMesh& mesh) {
  std::unique_ptr<AdaptiveMesh::Contents::Run> run = std::move(mesh.contents().run);
  return run->resampler->give_hierarchy();
}

AdaptiveMesh resample_from(Input&& input, std::optional<Resampler::MeshHierarchy> previous,
                           const ResampleOptions& options, Progress& progress) {
  const LoopProgress loops(progress);
  auto run = std::make_unique<AdaptiveMesh::Contents::Run>();
  run->input = std::move(input).release();
  check_options(options, run->input->facts);
  const ReconstructionOptions reconstruction{.smooth_labels = options.smooth_labels,
                                             .fractions = options.fractions};
  // If nobody else has the input, its interfaces are mended in place.
  run->source = run->input.use_count() == 1 ? run->input->take_source(reconstruction, progress)
                                            : run->input->source(reconstruction, progress);
  run->resampler.emplace(run->source, to_resampling_options(options, run->source), progress);
  if (previous) {
    run->resampler->refine(std::move(*previous));
  } else {
    run->resampler->refine();
  }
  progress.step("measuring", -1);
  ResampleReport report = report_of(*run->resampler, progress);
  auto contents = std::make_unique<AdaptiveMesh::Contents>(std::move(run));
  contents->report = std::move(report);
  return AdaptiveMesh(std::move(contents));
}

}  // namespace

AdaptiveMesh resample(Input input, const ResampleOptions& options, Progress& progress) {
  return resample_from(std::move(input), std::nullopt, options, progress);
}

AdaptiveMesh resample(Input input, AdaptiveMesh&& previous, const ResampleOptions& options,
                      Progress& progress) {
  static_cast<void>(previous.contents().kept_run("the next step"));
  AdaptiveMesh used = std::move(previous);
  return resample_from(std::move(input), take_hierarchy(used), options, progress);
}

AdaptiveMesh resample(const GridData& data, const ResampleOptions& options, Progress& progress) {
  AdaptiveMesh mesh = resample(Input(data), options, progress);
  mesh.release_input();
  return mesh;
}

AdaptiveMesh resample(const InterfaceTriangles& interfaces, const Box3& domain,
                      const ResampleOptions& options, Progress& progress) {
  AdaptiveMesh mesh = resample(Input(interfaces, domain), options, progress);
  mesh.release_input();
  return mesh;
}

void check(const ResampleOptions& options, const Input& input) {
  check_options(options, input.contents().facts);
}

}  // namespace adamas
