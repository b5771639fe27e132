#include "cli/series_figures.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

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

/// Adds a row for each material with its volume and the integrals of its fields.
void add_totals(const std::string& of, const std::vector<MaterialTotals>& materials,
                const std::vector<FieldRange>& fields, Figures& rows) {
  for (const MaterialTotals& totals : materials) {
    Figures integrals = Figures::object();
    std::size_t next = 0;
    for (const FieldRange& field : fields) {
      if (totals.integrals.empty()) continue;
      Figures components = Figures::array();
      for (int c = 0; c < field.components; ++c) components.push_back(totals.integrals[next++]);
      integrals[field.name] = field.components == 1 ? components[0] : components;
    }
    rows.push_back({{"of", of},
                    {"material", totals.name},
                    {"volume", totals.volume},
                    {"integrals", std::move(integrals)}});
  }
}

Figures adaptation_figures(const std::optional<DiamondCounts>& adaptation) {
  if (!adaptation) return nullptr;
  return {{"kept", adaptation->kept}, {"merged", adaptation->merged}, {"split", adaptation->split}};
}

Figures step_figures(const ResampledStep& step) {
  Figures figures{{"step", step.number}, {"time", step.entry.time}, {"file", step.entry.file}};
  figures.update(resample_json(step.report));
  add_masses(step.balance, figures["materials"]);
  figures["adaptation"] = adaptation_figures(step.adaptation);
  figures["ledger"] = Figures::array();
  add_totals("input", step.totals_input, step.fields, figures["ledger"]);
  add_totals("mesh", step.totals_mesh, step.fields, figures["ledger"]);
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

Figures damaged_steps(const ResampledSeries& series) {
  Figures numbers = Figures::array();
  for (const LeftOutStep& step : series.left_out) numbers.push_back(step.number);
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
