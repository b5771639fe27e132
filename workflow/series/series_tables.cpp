#include "workflow/series/series_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "adamas/report_text.h"
#include "adamas/text.h"
#include "core/base/error.h"

namespace adamas {

using namespace workflow;

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

double greatest_error(const ResampledStep& step, std::size_t field) {
  return step.report.fields[field].everywhere.max_error;
}

std::string difference(double before, double after) {
  return std::isfinite(after - before) ? difference_text(before, after) : "-";
}

TextTable sizes_table(const ResampledSeries& series) {
  TextTable table{
      "Steps",
      {"step", "time", "tetrahedra", "diamonds kept", "merged", "split", "error wanted", "certified"},
      {}};
  for (const FieldRange& field : series.fields) table.header.push_back("error of " + field.name);
  table.header.emplace_back("processor seconds");
  for (std::size_t n = 0; n < series.steps.size(); ++n) {
    const ResampledStep& step = series.steps[n];
    const auto diamonds = [&step](std::size_t Adaptation::*count) {
      return step.adaptation ? std::to_string((*step.adaptation).*count) : std::string("-");
    };
    std::vector<std::string> row{std::to_string(step.number),
                                 number(step.entry.time),
                                 std::to_string(step.report.tetrahedra),
                                 diamonds(&Adaptation::kept),
                                 diamonds(&Adaptation::merged),
                                 diamonds(&Adaptation::split),
                                 number(step.report.interface_error_target),
                                 number(certified_error(step))};
    for (std::size_t f = 0; f < series.fields.size(); ++f) row.push_back(number(greatest_error(step, f)));
    row.push_back(fmt::format("{:.2f}", step.processor_seconds));
    table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable differences_table(const ResampledSeries& series) {
  TextTable table{"How far volumes and masses in the mesh are from those of the input", {"step", "time"}, {}};
  const auto& materials = series.steps.front().balance;
  const std::size_t count = std::min(materials.size(), kMostMaterials);
  for (std::size_t m = 0; m < count; ++m) {
    table.header.push_back("volume of " + materials[m].material);
    if (!series.density.empty()) table.header.push_back("mass of " + materials[m].material);
  }
  for (std::size_t n = 0; n < series.steps.size(); ++n) {
    const ResampledStep& step = series.steps[n];
    std::vector<std::string> row{std::to_string(step.number), number(step.entry.time)};
    for (std::size_t m = 0; m < count; ++m) {
      const MaterialBalance& of = step.balance[m];
      row.push_back(difference(of.volume_input, of.volume_mesh));
      if (!series.density.empty()) row.push_back(difference(of.mass_input, of.mass_mesh));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

namespace workflow {

double certified_error(const ResampledStep& step) { return certified(step.report.interface_error); }
double attained_error(const ResampledStep& step) {
  const auto& distance = step.report.interface_error;
  return distance ? distance->found : kNone;
}

}  // namespace workflow

std::vector<TextTable> series_tables(const ResampledSeries& series) {
  return {sizes_table(series), differences_table(series)};
}

std::string series_csv(const ResampledSeries& series) {
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
  for (const FieldRange& field : series.fields)
    header.insert(header.end(), {"greatest error of " + field.name, "mean error of " + field.name});
  for (const MaterialBalance& row : series.steps.front().balance) {
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
  for (std::size_t n = 0; n < series.steps.size(); ++n) {
    const ResampledStep& step = series.steps[n];
    const ResampleReport& report = step.report;
    std::vector<std::string> cells{std::to_string(step.number),
                                   exact(step.entry.time),
                                   step.entry.file,
                                   std::to_string(report.tetrahedra),
                                   std::to_string(report.vertices),
                                   std::to_string(report.interface_tetrahedra),
                                   exact(step.report.interface_error_target),
                                   exact(certified_error(step)),
                                   exact(attained_error(step)),
                                   exact(certified(report.interface_error_per_material)),
                                   exact(certified(report.junction_error))};
    for (std::size_t f = 0; f < series.fields.size(); ++f) {
      const ResampleReport::Errors& errors = report.fields[f].everywhere;
      cells.insert(cells.end(), {exact(errors.max_error), exact(errors.mean_error)});
    }
    for (const MaterialBalance& row : step.balance)
      cells.insert(cells.end(), {exact(row.volume_input), exact(row.volume_mesh), exact(row.mass_input),
                                 exact(row.mass_mesh)});
    add_line(cells);
  }
  return text;
}

}  // namespace adamas
