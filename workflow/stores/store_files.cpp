#include "adamas/store_files.h"

#include <utility>

#include "core/base/error.h"
#include "core/base/notes.h"
#include "timevarying/api/build_options.h"
#include "timevarying/series_builder.h"
#include "workflow/stores/growing_store.h"
#include "workflow/stores/stored_steps.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;
using namespace workflow;

namespace {

StoreReport make_report(const StoredSteps& steps, const StoreFigures& figures) {
  StoreReport report;
  report.grid = steps.grid();
  report.steps = steps.count();
  report.input_bytes = steps.input_bytes();
  report.stored = build_report(figures);
  report.numbers = steps.number_type();
  report.array = steps.array();
  report.infinite_samples = steps.infinite_samples();
  return report;
}

/// Adds steps to a store, which is input and output: it stays whole even if that fails.
StoreReport append(const StoreRequest& request, VolumeInputSteps input, OutputSet& outputs,
                   Progress& progress) {
  const StoreOptions options = store_options(request.options);
  GrowingStore store(request.output.string());
  store.check(request.options);
  const std::string name = request.inputs.size() == 1
                               ? request.inputs[0]
                               : fmt::format("{} and {} more", request.inputs[0], request.inputs.size() - 1);
  std::vector<VolumeInputStep> later = store.later_steps(std::move(input), name, progress);
  if (later.empty()) return {};
  const std::string first = later.front().name;
  StoredSteps steps(std::move(later), outputs, progress);
  if (steps.grid() != store.grid()) refuse_grid(first, steps.grid(), request.output.string(), store.grid());
  const StoreFigures figures = store.add(steps, options, request.added, progress);
  steps.finish();
  StoreReport report = make_report(steps, figures);
  report.steps_before = store.steps();
  report.bytes_before = store.bytes();
  return report;
}

}  // namespace

StoreReport store_files(const StoreRequest& request, OutputSet& outputs, Progress& progress) {
  VolumeInputSteps input = find_volume_steps(request.inputs, request.input);
  if (!input.remark.empty()) note(progress, "{}", input.remark);
  const std::string output = request.output.string();
  std::error_code unknown;
  if (request.append && std::filesystem::exists(output, unknown))
    return append(request, std::move(input), outputs, progress);
  outputs.declare("-o", output, {".adm"});
  const StoreOptions options = store_options(request.options);
  StoredSteps steps(std::move(input.steps), outputs, progress);
  StoreFigures figures;
  outputs.write(output, [&](const auto& path) {
    figures = build_series(path, output, steps.source(), options, progress);
  });
  steps.finish();
  if (request.append && std::filesystem::exists(output, unknown))
    fail("{}: expected no store there, as when this run began, found one that was made meanwhile", output);
  return make_report(steps, figures);
}

}  // namespace adamas
