#include "adamas/resample.h"

#include "core/base/loop_progress.h"
#include "interfaces/library/adaptive_mesh.h"
#include "interfaces/library/input.h"
#include "interfaces/library/resample_options.h"
#include "interfaces/library/resample_report.h"
#include "interfaces/resampling/resampler.h"

namespace adamas {

using namespace interfaces;

AdaptiveMesh resample(const Input& input, const ResampleOptions& options, Progress& progress) {
  const LoopProgress loops(progress);
  check_options(options, input.contents().facts);
  const ResamplingSource source = input.contents().source(
      {.smooth_labels = options.smooth_labels, .fractions = options.fractions}, progress);
  Resampler resampler(source, to_resampling_options(options, source), progress);
  resampler.refine();
  progress.step("measuring", -1);
  auto contents = std::make_unique<AdaptiveMesh::Contents>();
  contents->report = report_of(resampler, progress);
  contents->mesh = resampled_mesh(resampler);
  contents->tetrahedra.reserve(contents->mesh.cells.size());
  for (const auto& cell : contents->mesh.cells) contents->tetrahedra.push_back(cell.vertices);
  return AdaptiveMesh(std::move(contents));
}

AdaptiveMesh resample(const GridData& data, const ResampleOptions& options, Progress& progress) {
  return resample(Input(data), options, progress);
}

AdaptiveMesh resample(const InterfaceTriangles& interfaces, const Box3& domain,
                      const ResampleOptions& options, Progress& progress) {
  return resample(Input(interfaces, domain), options, progress);
}

}  // namespace adamas
