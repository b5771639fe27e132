#include "workflow/series/series_report.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "adamas/file_names.h"
#include "adamas/files.h"
#include "adamas/report_text.h"
#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/output_stream.h"
#include "core/picture/picture_api.h"

namespace adamas {

using namespace picture;
using namespace workflow;

namespace {

/// Tables and curves of more materials would not be read.
constexpr std::size_t kMostMaterials = 12;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double certified(const std::optional<MeasuredDistance>& distance) {
  return distance ? distance->certified : kNone;
}

/// The distance between the interfaces of the input and the mesh, certified and attained; NaN where it was
/// not measured.
double certified_error(const ResampledStep& step) { return certified(step.report.interface_error); }
double attained_error(const ResampledStep& step) {
  const auto& distance = step.report.interface_error;
  return distance ? distance->found : kNone;
}

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-"; }
/// Returns a value with all its digits; an empty text where it is not known.
std::string exact(double value) { return std::isfinite(value) ? fmt::format("{}", value) : std::string(); }

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
      const MaterialBalance& balance = step.balance[m];
      row.push_back(difference(balance.volume_input, balance.volume_mesh));
      if (!series.density.empty()) row.push_back(difference(balance.mass_input, balance.mass_mesh));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

PlotSeries series_of(const ResampledSeries& record, std::string name,
                     const std::function<double(const ResampledStep&)>& value) {
  PlotSeries series{.name = std::move(name)};
  for (const ResampledStep& step : record.steps) {
    series.x.push_back(step.entry.time);
    series.y.push_back(value(step));
  }
  return series;
}

Plot over_time(const std::string& label, AxisKind kind = AxisKind::kLinear) {
  Plot plot;
  plot.x = {"time"};
  plot.y = {label, kind};
  return plot;
}

bool shows_anything(const PlotSeries& series) {
  return std::any_of(series.y.begin(), series.y.end(), [](double y) { return std::isfinite(y); });
}

/// Two lines for each material in its colour and with markers of its own: dashed and open what the input has,
/// and filled what the mesh has; both as parts of the greatest that the input ever has, so that small
/// materials are seen too.
Plot material_plot(const ResampledSeries& record, const std::string& label, double MaterialBalance::*input,
                   double MaterialBalance::*mesh) {
  Plot plot = over_time(label + ", as a part of the greatest in the input");
  plot.series.push_back(
      {.name = "the input", .dashed = true, .colour = Colour{0.4, 0.4, 0.4}, .marker = 0, .open = true});
  const auto& materials = record.steps.front().balance;
  for (std::size_t m = 0; m < std::min(materials.size(), kMostMaterials); ++m) {
    double greatest = 0;
    for (const ResampledStep& step : record.steps) greatest = std::max(greatest, step.balance[m].*input);
    if (!(greatest > 0)) continue;
    const auto relative = [&record, &materials, m, greatest](std::string name,
                                                             double MaterialBalance::*value) {
      PlotSeries series = series_of(record, std::move(name), [m, value, greatest](const ResampledStep& step) {
        return step.balance[m].*value / greatest;
      });
      series.colour = colour_of(record.colours, materials[m].material, m);
      series.marker = m;
      return series;
    };
    PlotSeries of_input = relative("", input);
    of_input.dashed = true;
    of_input.open = true;
    plot.series.push_back(std::move(of_input));
    plot.series.push_back(relative(materials[m].material, mesh));
  }
  return plot;
}

Plot error_plot(const ResampledSeries& record) {
  Plot plot = over_time("interface error");
  plot.series = {series_of(record, "wanted",
                           [](const ResampledStep& step) { return step.report.interface_error_target; }),
                 series_of(record, "certified", certified_error),
                 series_of(record, "attained (lower bound)", attained_error)};
  plot.series[0].markers = false;
  plot.series[0].dashed = true;
  plot.y.low = 0;
  return plot;
}

/// Fields that the mesh has exactly are named in the legend alone.
Plot field_plot(const ResampledSeries& record) {
  std::string exact;
  Plot plot = over_time("mean field error / range", AxisKind::kLogarithmic);
  for (std::size_t f = 0; f < record.fields.size(); ++f) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const ResampledStep& step : record.steps) {
      least = std::min(least, step.fields[f].min);
      most = std::max(most, step.fields[f].max);
    }
    PlotSeries series =
        series_of(record, record.fields[f].name, [f, range = most - least](const ResampledStep& step) {
          const double mean = step.report.fields[f].everywhere.mean_error;
          const double error = range > 0 ? mean / range : kNone;
          // Errors of a field that the mesh reproduces exactly are round-off, which would stretch the axis.
          return error > 1e-12 ? error : kNone;
        });
    if (!shows_anything(series)) exact += (exact.empty() ? "" : ", ") + series.name;
    plot.series.push_back(std::move(series));
  }
  if (!exact.empty())
    plot.series.push_back({.name = "without error: " + exact, .line = false, .markers = false});
  return plot;
}

}  // namespace

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

namespace workflow {

std::vector<SeriesCurve> series_curves(const ResampledSeries& record) {
  std::vector<SeriesCurve> curves;
  const auto add = [&curves](const std::string& name, Plot plot, const std::string& caption) {
    if (std::none_of(plot.series.begin(), plot.series.end(), shows_anything)) return;
    std::erase_if(plot.series, [](const PlotSeries& s) { return !s.x.empty() && !shows_anything(s); });
    curves.push_back({name, caption, std::move(plot)});
  };
  Plot sizes = over_time("tetrahedra");
  sizes.series = {
      series_of(record, "tetrahedra",
                [](const ResampledStep& step) { return static_cast<double>(step.report.tetrahedra); }),
      series_of(record, "with interfaces", [](const ResampledStep& step) {
        return static_cast<double>(step.report.interface_tetrahedra);
      })};
  sizes.y.low = 0;
  add("series-tetrahedra", std::move(sizes), "The size of the mesh over time.");
  add("series-interface-error", error_plot(record),
      "Two-sided distance between the interfaces of input and mesh over time: no point is farther than the "
      "certified error.");
  add("series-field-error", field_plot(record),
      "Mean field errors over time, as parts of each field's range over all steps.");
  add("series-volumes",
      material_plot(record, "volume", &MaterialBalance::volume_input, &MaterialBalance::volume_mesh),
      "Volumes of the materials over time: in the mesh, and dashed with open markers in the input, as parts "
      "of the greatest in "
      "the input.");
  add("series-masses",
      material_plot(record, "mass", &MaterialBalance::mass_input, &MaterialBalance::mass_mesh),
      "Masses of the materials over time: in the mesh, and dashed with open markers in the input, as parts "
      "of the greatest in "
      "the input.");
  return curves;
}

}  // namespace workflow

void write_series_curves(const std::filesystem::path& path, const ResampledSeries& series) {
  if (file_extension(path) == ".csv") return write_text(path, series_csv(series));
  std::vector<Plot> plots;
  for (SeriesCurve& curve : series_curves(series)) plots.push_back(std::move(curve.plot));
  write_bytes(path, draw_plots(plots, picture_format(path), {.columns = 2}));
}

}  // namespace adamas
