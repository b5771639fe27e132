#include "cli/series_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace adamas::cli {

using namespace interfaces;
using namespace picture;

namespace {

/// Tables and curves of more materials would not be read.
constexpr std::size_t kMostMaterials = 12;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-"; }
/// With all its digits; empty where it is not known.
std::string exact(double value) { return std::isfinite(value) ? fmt::format("{}", value) : std::string(); }

double certified(const std::optional<MeasuredDistance>& distance) {
  return distance ? distance->certified : kNone;
}

double greatest_error(const SeriesStep& step, std::size_t field) {
  return step.run.report.fields[field].everywhere.max_error;
}

std::string difference(double before, double after) {
  return std::isfinite(after - before) ? difference_text(before, after) : "-";
}

TextTable sizes_table(const SeriesRecord& record) {
  TextTable table{
      "Steps",
      {"step", "time", "tetrahedra", "diamonds kept", "merged", "split", "error wanted", "certified"},
      {}};
  for (const FieldInfo& field : record.fields) table.header.push_back("error of " + field.name);
  table.header.push_back("processor seconds");
  for (std::size_t n = 0; n < record.steps.size(); ++n) {
    const SeriesStep& step = record.steps[n];
    const auto diamonds = [&step](std::size_t Adaptation::*count) {
      return step.adaptation ? std::to_string((*step.adaptation).*count) : std::string("-");
    };
    std::vector<std::string> row{std::to_string(step.number),
                                 number(step.entry.time),
                                 std::to_string(step.run.report.tetrahedra),
                                 diamonds(&Adaptation::kept),
                                 diamonds(&Adaptation::merged),
                                 diamonds(&Adaptation::split),
                                 number(step.run.options.interface_error),
                                 number(certified_error(step))};
    for (std::size_t f = 0; f < record.fields.size(); ++f) row.push_back(number(greatest_error(step, f)));
    row.push_back(fmt::format("{:.2f}", step.processor_seconds));
    table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable differences_table(const SeriesRecord& record) {
  TextTable table{"How far volumes and masses in the mesh are from those of the input", {"step", "time"}, {}};
  const auto& materials = record.steps.front().ledger;
  const std::size_t count = std::min(materials.size(), kMostMaterials);
  for (std::size_t m = 0; m < count; ++m) {
    table.header.push_back("volume of " + materials[m].material);
    if (!record.density.empty()) table.header.push_back("mass of " + materials[m].material);
  }
  for (std::size_t n = 0; n < record.steps.size(); ++n) {
    const SeriesStep& step = record.steps[n];
    std::vector<std::string> row{std::to_string(step.number), number(step.entry.time)};
    for (std::size_t m = 0; m < count; ++m) {
      const LedgerRow& of = step.ledger[m];
      row.push_back(difference(of.volume_input, of.volume_mesh));
      if (!record.density.empty()) row.push_back(difference(of.mass_input, of.mass_mesh));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

double certified_error(const SeriesStep& step) { return certified(step.run.report.interface_error); }
double attained_error(const SeriesStep& step) {
  const auto& distance = step.run.report.interface_error;
  return distance ? distance->found : kNone;
}

Figures series_figures(const SeriesRecord& record) {
  Figures rows = Figures::array();
  for (std::size_t n = 0; n < record.steps.size(); ++n) {
    const SeriesStep& step = record.steps[n];
    Figures row{{"step", step.number}, {"time", step.entry.time}, {"file", step.entry.file}};
    row.update(step.run.json);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<TextTable> series_tables(const SeriesRecord& record) {
  return {sizes_table(record), differences_table(record)};
}

void print_series(const SeriesRecord& record, Console& console) {
  bool first = true;
  for (const TextTable& table : series_tables(record)) {
    std::vector<std::vector<std::string>> rows{table.header};
    rows.insert(rows.end(), table.rows.begin(), table.rows.end());
    if (!first) console.print("\n{}\n", table.caption);
    first = false;
    console.table(std::move(rows));
  }
}

std::string series_csv(const SeriesRecord& record) {
  std::vector<std::string> header{"step",
                                  "time",
                                  "file",
                                  "tetrahedra",
                                  "vertices",
                                  "interface tetrahedra",
                                  "interface error wanted",
                                  "interface error certified",
                                  "interface error found",
                                  "interface error per material certified",
                                  "junction error certified"};
  for (const FieldInfo& field : record.fields)
    header.insert(header.end(), {"greatest error of " + field.name, "mean error of " + field.name});
  for (const LedgerRow& row : record.steps.front().ledger) {
    for (const char* what : {"volume of ", "mass of "})
      header.insert(header.end(),
                    {what + row.material + " in the input", what + row.material + " in the mesh"});
  }
  std::string text;
  const auto add_line = [&text](const std::vector<std::string>& cells) {
    for (std::size_t c = 0; c < cells.size(); ++c) text += (c == 0 ? "" : ",") + csv_text(cells[c]);
    text += "\n";
  };
  add_line(header);
  for (std::size_t n = 0; n < record.steps.size(); ++n) {
    const SeriesStep& step = record.steps[n];
    const ResampleReport& report = step.run.report;
    std::vector<std::string> cells{std::to_string(step.number),
                                   exact(step.entry.time),
                                   step.entry.file,
                                   std::to_string(report.tetrahedra),
                                   std::to_string(report.vertices),
                                   std::to_string(report.interface_tetrahedra),
                                   exact(step.run.options.interface_error),
                                   exact(certified_error(step)),
                                   exact(attained_error(step)),
                                   exact(certified(report.interface_error_per_material)),
                                   exact(certified(report.junction_error))};
    for (std::size_t f = 0; f < record.fields.size(); ++f) {
      const ResampleReport::Errors& errors = report.fields[f].everywhere;
      cells.insert(cells.end(), {exact(errors.max_error), exact(errors.mean_error)});
    }
    for (const LedgerRow& row : step.ledger)
      cells.insert(cells.end(), {exact(row.volume_input), exact(row.volume_mesh), exact(row.mass_input),
                                 exact(row.mass_mesh)});
    add_line(cells);
  }
  return text;
}

}  // namespace adamas::cli
