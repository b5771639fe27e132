#include "workflow/series/follow_steps.h"

#include <utility>

#include "core/base/error.h"
#include "interfaces/library/resample_options.h"
#include "workflow/input/left_out_steps.h"
#include "workflow/input/loading.h"
#include "workflow/input/named_progress.h"
#include "workflow/input/series_forms.h"
#include "workflow/series/balance.h"
#include "workflow/series/series_resampler.h"

namespace adamas::workflow {

using namespace interfaces;

ResampledSeries follow_steps(const std::vector<SeriesEntry>& steps, const ResampleSeriesOptions& options,
                             const StepActions& actions, Progress& progress) {
  ResampledSeries series;
  LeftOutSteps left_out;
  SeriesForms forms;
  NamedProgress named(progress);
  SeriesResampler resampler(options.resampling, named);
  const ReconstructionOptions how = reconstruction_of(options.resampling);
  const auto check = [&options](const InputFacts& found) { check_options(options.resampling, found); };
  InputOptions from = options.input;
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const std::string& file = steps[n].file;
    named.set_name(file);
    LoadedInput input;
    from.path = file;
    if (!left_out.read(n, [&] { input = load_input(from, how, named, check); })) {
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
  series.left_out = left_out.all();
  return series;
}

}  // namespace adamas::workflow
