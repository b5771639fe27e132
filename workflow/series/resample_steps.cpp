#include "workflow/series/resample_steps.h"

#include <utility>

#include "core/base/error.h"
#include "interfaces/api/resample_options.h"
#include "workflow/input/series_forms.h"
#include "workflow/series/balance.h"
#include "workflow/series/named_progress.h"
#include "workflow/series/series_resampler.h"
#include "workflow/series/step_reader.h"

namespace adamas::workflow {

using namespace interfaces;

ResampledSeries resample_steps(const std::vector<SeriesEntry>& steps, const ResampleSeriesOptions& options,
                             const StepActions& actions, Progress& progress) {
  ResampledSeries series;
  LeftOutSteps left_out;
  SeriesForms forms;
  NamedProgress named(progress);
  SeriesResampler resampler(options.resampling, named);
  const StepReader reader{options.input, options.resampling, options.fraction_option,
                          [&options](const InputFacts& found) { check_options(options.resampling, found); }};
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const std::string& file = steps[n].file;
    named.set_name(file);
    LoadedInput input;
    if (!reader.read_step(n, file, left_out, input, named)) {
      if (actions.leave_out) actions.leave_out(n);
      continue;
    }
    if (!input.data)
      fail("{}: expected data on a grid, as all steps of a series are, found interfaces", file);
    forms.check(file, *input.data);
    if (series.steps.empty()) {
      std::vector<FieldInfo> fields;
      if (input.source.fields) fields = input.source.fields->fields();
      series.fields = summarize(fields);
      series.density = density_field(options.density, fields, file);
    }
    ResampledMesh mesh;
    ResampledStep step = resampler.resample(input, series.density, mesh);
    step.entry = steps[n];
    step.number = n;
    series.steps.push_back(std::move(step));
    actions.finish(n, mesh);
  }
  left_out.check(steps.size());
  for (const auto& [number, problem] : left_out.problems()) series.left_out.push_back({number, problem});
  return series;
}

}  // namespace adamas::workflow
