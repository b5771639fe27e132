#include "workflow/series/resample_steps.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "adamas/progress.h"
#include "adamas/report_text.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "interfaces/api/material_totals.h"
#include "interfaces/api/resample_options.h"
#include "interfaces/api/resample_report.h"
#include "interfaces/cross_section/field_choice.h"
#include "interfaces/probe/material_integrals.h"
#include "interfaces/resampling/resampler.h"
#include "workflow/input/left_out_steps.h"
#include "workflow/input/named_progress.h"
#include "workflow/input/read_input.h"
#include "workflow/input/series_forms.h"
#include "workflow/series/balance.h"

namespace adamas::workflow {

using namespace interfaces;

namespace {

/// Resamples the steps of a series one after another, each from the mesh of the step before.
class SeriesResampler {
 public:
  SeriesResampler(const ResampleOptions& options, Progress& progress)
      : options_(options), progress_(progress) {}

  /// Resamples the next step and returns its figures; `mesh` gives access to its mesh. `density`: the field
  /// whose integral is mass; empty: there is none. The caller sets the entry and the number of the step.
  ResampledStep resample(const LoadedInput& input, const std::string& density, ResampledMesh& mesh);

 private:
  const ResampleOptions& options_;
  Progress& progress_;
  std::optional<Resampler::MeshHierarchy> previous_;
};

ResampledStep SeriesResampler::resample(const LoadedInput& input, const std::string& density,
                                        ResampledMesh& mesh) {
  const ResamplingSource& source = input.source;
  ResampledStep step;
  const ResamplingOptions options = to_resampling_options(options_, source);
  const Stopwatch watch;
  Resampler resampler(source, options, progress_);
  if (previous_) {
    resampler.refine(std::move(*previous_));
  } else {
    resampler.refine();
  }
  step.processor_seconds = watch.processor_seconds();
  step.seconds = watch.seconds();
  step.adaptation = resampler.adaptation();
  progress_.step("measuring", -1);
  step.report = report_of(resampler, progress_);
  note_resampled(step.report, progress_);
  mesh = resampled_mesh(resampler);
  std::vector<FieldInfo> fields;
  if (source.fields) fields = source.fields->fields();
  step.fields = summarize(fields);
  IdVector<MaterialId, MaterialIntegral> of_input =
      input.data ? material_integrals(*input.data) : material_integrals(*input.cells, source.volumes);
  IdVector<MaterialId, MaterialIntegral> of_mesh = material_integrals(mesh);
  std::optional<std::size_t> mass;
  if (!density.empty()) mass = fields[find_field(fields, density, source.name).field].offset;
  step.balance = balance_of(source.materials, of_input, of_mesh, mass, mass);
  step.totals_input = to_totals(std::move(of_input), source.materials);
  step.totals_mesh = to_totals(std::move(of_mesh), source.materials);
  previous_ = resampler.give_hierarchy();
  return step;
}

}  // namespace

ResampledSeries resample_steps(const std::vector<SeriesEntry>& steps, const ResampleSeriesOptions& options,
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
    const std::string file = steps[n].name();
    named.set_name(file);
    LoadedInput input;
    from.path = steps[n].file;
    from.data.time = steps[n].number;
    if (!left_out.read(n, [&] { input = load_input(from, how, named, check); })) {
      if (actions.leave_out) actions.leave_out(n);
      continue;
    }
    if (!input.data && !input.cells)
      fail("{}: expected data on a grid or on a mesh, as all steps of a series are, found interfaces", file);
    std::vector<FieldInfo> fields;
    if (input.source.fields) fields = input.source.fields->fields();
    input.data ? forms.check(file, *input.data) : forms.check(file, *input.cells, fields);
    if (series.steps.empty()) {
      series.fields = summarize(fields);
      series.density = density_field(options.density, fields, file);
    }
    ResampledMesh mesh;
    ResampledStep step = resampler.resample(input, series.density, mesh);
    step.entry = steps[n];
    step.number = n;
    series.steps.push_back(std::move(step));
    series.colours.merge(find_material_colours(from));
    actions.finish(n, mesh, series.colours);
  }
  left_out.check(steps.size());
  series.left_out = left_out.all();
  return series;
}

}  // namespace adamas::workflow
