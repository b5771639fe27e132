#include "cli/series_run.h"

#include <chrono>
#include <cmath>
#include <ctime>

#include "adamas/report_text.h"
#include "cli/ledger.h"
#include "interfaces/cross_section/field_choice.h"
#include "interfaces/library/input.h"
#include "interfaces/library/material_totals.h"
#include "interfaces/library/resample_options.h"
#include "interfaces/library/resample_report.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::cli {

using namespace interfaces;
using namespace io;

namespace {

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Adds masses to the rows of the materials, where they have any.
void add_masses(const std::vector<LedgerRow>& ledger, Figures& materials) {
  for (std::size_t m = 0; m < ledger.size(); ++m) {
    if (!std::isfinite(ledger[m].mass_input + ledger[m].mass_mesh)) continue;
    materials[m]["mass_input"] = ledger[m].mass_input;
    materials[m]["mass_mesh"] = ledger[m].mass_mesh;
  }
}

Figures adaptation_figures(const std::optional<Adaptation>& adaptation) {
  if (!adaptation) return nullptr;
  return {{"kept", adaptation->kept}, {"merged", adaptation->merged}, {"split", adaptation->split}};
}

}  // namespace

SeriesStep SeriesResampler::resample(const SeriesEntry& entry, const workflow::LoadedInput& input,
                                     const std::string& density, ResampledMesh& mesh) {
  const ResamplingSource& source = input.source;
  SeriesStep step;
  step.entry = entry;
  step.run.options = to_resampling_options(options_, source);
  const auto start = std::chrono::steady_clock::now();
  const double before = processor_seconds();
  Resampler resampler(source, step.run.options, console_);
  if (previous_) {
    resampler.refine(std::move(*previous_));
  } else {
    resampler.refine();
  }
  step.processor_seconds = processor_seconds() - before;
  step.run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  step.adaptation = resampler.adaptation();
  console_.step("measuring", -1);
  step.run.report = report_of(resampler, console_);
  note_resampled(step.run.report, console_);
  step.run.unreached = unreached_lines(step.run.report);
  mesh = resampled_mesh(resampler);
  if (source.fields) step.fields = source.fields->fields();
  const auto of_input = material_integrals(*input.data), of_mesh = material_integrals(mesh);
  std::optional<std::size_t> mass;
  if (!density.empty()) mass = step.fields[find_field(step.fields, density, source.name).field].offset;
  step.ledger = ledger_rows(source.materials, of_input, of_mesh, mass, mass);

  Figures& json = step.run.json;
  json = resample_json(step.run.report);
  add_masses(step.ledger, json["materials"]);
  json["adaptation"] = adaptation_figures(step.adaptation);
  json["ledger"] = ledger_figures(
      {{"input", to_totals(IdVector<MaterialId, MaterialIntegral>(of_input), source.materials)},
       {"mesh", to_totals(IdVector<MaterialId, MaterialIntegral>(of_mesh), source.materials)}},
      describe(step.fields));
  json["seconds"] = step.run.seconds;
  json["processor_seconds"] = step.processor_seconds;
  previous_ = resampler.give_hierarchy();
  return step;
}

}  // namespace adamas::cli
