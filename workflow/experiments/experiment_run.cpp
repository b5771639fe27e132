#include "workflow/experiments/experiment_run.h"

#include <algorithm>

#include "core/base/stopwatch.h"
#include "interfaces/api/resample_report.h"
#include "interfaces/resampling/nested_errors.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::workflow {

using namespace interfaces;

namespace {

NestedFieldErrors nested_summary(const Resampler& resampler, std::size_t field) {
  const NestedErrors nested = nest_field_errors(resampler, field);
  const CorrectedErrors corrected = correct_field_errors(resampler, field);
  const auto& hierarchy = resampler.hierarchy();
  NestedFieldErrors result;
  result.undefined = corrected.undefined;
  std::vector<TetrahedronId> open = hierarchy.roots();
  while (!open.empty()) {
    const TetrahedronId t = open.back();
    open.pop_back();
    if (hierarchy.is_leaf(t)) continue;
    const auto children = hierarchy.children(t);
    open.insert(open.end(), children.begin(), children.end());
    const double direct = nested[t], sum = corrected.of_tetrahedra[t.value];
    result.greatest = std::max(result.greatest, direct);
    result.corrected_greatest = std::max(result.corrected_greatest, sum);
    result.mean += direct;
    result.corrected_mean += sum;
    ++result.tetrahedra;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(result.tetrahedra, 1));
  result.mean /= count;
  result.corrected_mean /= count;
  return result;
}

}  // namespace

ExperimentRun run_resampler(const ResamplingSource& source, const ResamplingOptions& options,
                            Progress& progress, ResampledMesh* mesh, InterfaceMesh* interfaces) {
  const Stopwatch watch;
  Resampler resampler(source, options, progress);
  resampler.refine();
  const double seconds = watch.seconds(), of_processors = watch.processor_seconds();
  progress.step("measuring", -1);
  ExperimentRun run;
  run.report = report_of(resampler, progress);
  run.seconds = seconds;
  run.processor_seconds = of_processors;
  if (interfaces != nullptr) *interfaces = approximated_interfaces(resampler, progress).mesh;
  if (mesh != nullptr) {
    *mesh = resampled_mesh(resampler);
    for (std::size_t f = 0; f < run.report.fields.size(); ++f)
      run.nested.push_back(nested_summary(resampler, f));
  }
  return run;
}

}  // namespace adamas::workflow
