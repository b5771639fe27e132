#include "cli/series_figures.h"

#include <cmath>
#include <string>
#include <vector>

#include "cli/ledger.h"
#include "cli/resample_figures.h"

namespace adamas::cli {

namespace {

/// Adds masses to the rows of the materials that have any.
void add_masses(const std::vector<MaterialBalance>& balance, Figures& materials) {
  for (std::size_t m = 0; m < balance.size(); ++m) {
    if (!std::isfinite(balance[m].mass_input + balance[m].mass_mesh)) continue;
    materials[m]["mass_input"] = balance[m].mass_input;
    materials[m]["mass_mesh"] = balance[m].mass_mesh;
  }
}

Figures adaptation_figures(const std::optional<Adaptation>& adaptation) {
  if (!adaptation) return nullptr;
  return {{"kept", adaptation->kept}, {"merged", adaptation->merged}, {"split", adaptation->split}};
}

Figures step_figures(const ResampledStep& step) {
  Figures figures{{"step", step.number}, {"time", step.entry.time}, {"file", step.entry.file}};
  figures.update(resample_json(step.report));
  add_masses(step.balance, figures["materials"]);
  figures["adaptation"] = adaptation_figures(step.adaptation);
  std::vector<FieldDescription> fields;
  for (const FieldRange& field : step.fields) fields.push_back({field.name, field.unit, field.components});
  figures["ledger"] = ledger_figures({{"input", step.totals_input}, {"mesh", step.totals_mesh}}, fields);
  figures["seconds"] = step.seconds;
  figures["processor_seconds"] = step.processor_seconds;
  return figures;
}

}  // namespace

Figures series_figures(const ResampledSeries& series) {
  Figures rows = Figures::array();
  for (const ResampledStep& step : series.steps) rows.push_back(step_figures(step));
  return rows;
}

Figures damaged_steps(const std::vector<LeftOutStep>& steps) {
  Figures numbers = Figures::array();
  for (const LeftOutStep& step : steps) numbers.push_back(step.number);
  return numbers;
}

void print_series(const ResampledSeries& series, Console& console) {
  bool first = true;
  for (const TextTable& table : series_tables(series)) {
    std::vector<std::vector<std::string>> rows{table.header};
    rows.insert(rows.end(), table.rows.begin(), table.rows.end());
    if (!first) console.print("\n{}\n", table.caption);
    first = false;
    console.table(std::move(rows));
  }
}

}  // namespace adamas::cli
