#include "workflow/series/series_resampler.h"

#include <chrono>
#include <ctime>
#include <utility>

#include "adamas/report_text.h"
#include "interfaces/cross_section/field_choice.h"
#include "interfaces/library/material_totals.h"
#include "interfaces/library/resample_options.h"
#include "interfaces/library/resample_report.h"
#include "interfaces/probe/material_integrals.h"
#include "workflow/series/balance.h"

namespace adamas::workflow {

using namespace interfaces;

namespace {

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

ResampledStep SeriesResampler::resample(const LoadedInput& input, const std::string& density,
                                        ResampledMesh& mesh) {
  const ResamplingSource& source = input.source;
  ResampledStep step;
  const ResamplingOptions options = to_resampling_options(options_, source);
  const auto start = std::chrono::steady_clock::now();
  const double before = processor_seconds();
  Resampler resampler(source, options, progress_);
  if (previous_) {
    resampler.refine(std::move(*previous_));
  } else {
    resampler.refine();
  }
  step.processor_seconds = processor_seconds() - before;
  step.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  step.adaptation = resampler.adaptation();
  progress_.step("measuring", -1);
  step.report = report_of(resampler, progress_);
  note_resampled(step.report, progress_);
  mesh = resampled_mesh(resampler);
  std::vector<FieldInfo> fields;
  if (source.fields) fields = source.fields->fields();
  step.fields = summarize(fields);
  IdVector<MaterialId, MaterialIntegral> of_input = material_integrals(*input.data);
  IdVector<MaterialId, MaterialIntegral> of_mesh = material_integrals(mesh);
  std::optional<std::size_t> mass;
  if (!density.empty()) mass = fields[find_field(fields, density, source.name).field].offset;
  step.balance = balance_of(source.materials, of_input, of_mesh, mass, mass);
  step.totals_input = to_totals(std::move(of_input), source.materials);
  step.totals_mesh = to_totals(std::move(of_mesh), source.materials);
  previous_ = resampler.give_hierarchy();
  return step;
}

}  // namespace adamas::workflow
