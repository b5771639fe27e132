#include "cli/series_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/picture/palette.h"

namespace adamas {

namespace {

/// Tables and curves of more materials would not be read.
constexpr std::size_t kMostMaterials = 12;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-"; }
/// With all its digits; empty where it is not known.
std::string exact(double value) { return std::isfinite(value) ? fmt::format("{}", value) : std::string(); }

double certified(const SeriesStep& step) {
  return step.run.certificate ? step.run.certificate->networks.upper : kNone;
}
double attained(const SeriesStep& step) {
  return step.run.certificate ? step.run.certificate->networks.lower : kNone;
}

double greatest_error(const SeriesStep& step, std::size_t field) {
  const FieldError& all = step.run.figures.fields[field].all;
  return all.count() > 0 ? all.max : kNone;
}

std::string difference(double before, double after) {
  return std::isfinite(after - before) ? difference_text(before, after) : "-";
}

ReportTable sizes_table(const SeriesRecord& record) {
  ReportTable table{
      "Steps", {"step", "time", "tetrahedra", "diamonds kept", "merged", "split", "error wanted", "certified"}, {}};
  for (const FieldInfo& field : record.fields) table.header.push_back("error of " + field.name);
  table.header.push_back("processor seconds");
  for (std::size_t n = 0; n < record.steps.size(); ++n) {
    const SeriesStep& step = record.steps[n];
    const auto diamonds = [&step](std::size_t Adaptation::*count) {
      return step.adaptation ? std::to_string((*step.adaptation).*count) : std::string("-");
    };
    std::vector<std::string> row{std::to_string(n),
                                 number(step.entry.time),
                                 std::to_string(step.run.figures.tetrahedra),
                                 diamonds(&Adaptation::kept),
                                 diamonds(&Adaptation::merged),
                                 diamonds(&Adaptation::split),
                                 number(step.run.options.interface_error),
                                 number(certified(step))};
    for (std::size_t f = 0; f < record.fields.size(); ++f) row.push_back(number(greatest_error(step, f)));
    row.push_back(fmt::format("{:.2f}", step.processor_seconds));
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable differences_table(const SeriesRecord& record) {
  ReportTable table{
      "How far volumes and masses in the mesh are from those of the input", {"step", "time"}, {}};
  const auto& materials = record.steps.front().ledger;
  const std::size_t count = std::min(materials.size(), kMostMaterials);
  for (std::size_t m = 0; m < count; ++m) {
    table.header.push_back("volume of " + materials[m].material);
    if (!record.density.empty()) table.header.push_back("mass of " + materials[m].material);
  }
  for (std::size_t n = 0; n < record.steps.size(); ++n) {
    const SeriesStep& step = record.steps[n];
    std::vector<std::string> row{std::to_string(n), number(step.entry.time)};
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

Figures series_figures(const SeriesRecord& record) {
  Figures rows = Figures::array();
  for (std::size_t n = 0; n < record.steps.size(); ++n) {
    const SeriesStep& step = record.steps[n];
    Figures row{{"step", n}, {"time", step.entry.time}, {"file", step.entry.file}};
    row.update(step.run.json);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<ReportTable> series_tables(const SeriesRecord& record) {
  return {sizes_table(record), differences_table(record)};
}

void print_series(const SeriesRecord& record, Console& console) {
  bool first = true;
  for (const ReportTable& table : series_tables(record)) {
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
    const ResampleFigures& figures = step.run.figures;
    const auto& certificate = step.run.certificate;
    std::vector<std::string> cells{
        std::to_string(n),
        exact(step.entry.time),
        step.entry.file,
        std::to_string(figures.tetrahedra),
        std::to_string(figures.vertices),
        std::to_string(figures.interface_tetrahedra),
        exact(step.run.options.interface_error),
        exact(certified(step)),
        exact(attained(step)),
        exact(certificate ? certificate->materials.upper : kNone),
        exact(certificate && certificate->junctions ? certificate->junctions->upper : kNone)};
    for (std::size_t f = 0; f < record.fields.size(); ++f) {
      const FieldError& all = figures.fields[f].all;
      cells.insert(cells.end(),
                   {exact(greatest_error(step, f)), exact(all.count() > 0 ? all.mean() : kNone)});
    }
    for (const LedgerRow& row : step.ledger)
      cells.insert(cells.end(), {exact(row.volume_input), exact(row.volume_mesh), exact(row.mass_input),
                                 exact(row.mass_mesh)});
    add_line(cells);
  }
  return text;
}

namespace {

PlotSeries series_of(const SeriesRecord& record, std::string name,
                     const std::function<double(const SeriesStep&)>& value) {
  PlotSeries series{.name = std::move(name)};
  for (const SeriesStep& step : record.steps) {
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

/// Two lines for each material in its colour: dashed what the input has, and with marks what the mesh has.
Plot material_plot(const SeriesRecord& record, const std::string& label, double LedgerRow::*input,
                   double LedgerRow::*mesh) {
  Plot plot = over_time(label);
  const auto& materials = record.steps.front().ledger;
  for (std::size_t m = 0; m < std::min(materials.size(), kMostMaterials); ++m) {
    const auto of = [&record, m](std::string name, double LedgerRow::*value) {
      PlotSeries series = series_of(record, std::move(name),
                                    [m, value](const SeriesStep& step) { return step.ledger[m].*value; });
      series.colour = material_colour(m);
      return series;
    };
    PlotSeries of_input = of("", input), of_mesh = of(materials[m].material, mesh);
    of_input.markers = false;
    of_input.dashed = true;
    if (!shows_anything(of_mesh)) continue;
    plot.series.push_back(std::move(of_input));
    plot.series.push_back(std::move(of_mesh));
  }
  return plot;
}

Plot error_plot(const SeriesRecord& record) {
  Plot plot = over_time("interface error");
  plot.series = {
      series_of(record, "wanted", [](const SeriesStep& step) { return step.run.options.interface_error; }),
      series_of(record, "certified", certified), series_of(record, "attained (lower bound)", attained)};
  plot.series[0].markers = false;
  plot.series[0].dashed = true;
  plot.y.low = 0;
  return plot;
}

Plot field_plot(const SeriesRecord& record) {
  Plot plot = over_time("mean field error / range", AxisKind::kLogarithmic);
  for (std::size_t f = 0; f < record.fields.size(); ++f) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const SeriesStep& step : record.steps) {
      least = std::min(least, step.fields[f].min);
      most = std::max(most, step.fields[f].max);
    }
    PlotSeries series =
        series_of(record, record.fields[f].name, [f, range = most - least](const SeriesStep& step) {
          const FieldError& all = step.run.figures.fields[f].all;
          return all.count() > 0 && range > 0 ? all.mean() / range : kNone;
        });
    // The errors of a field that the mesh reproduces exactly are round-off, which would stretch the axis.
    if (std::any_of(series.y.begin(), series.y.end(), [](double y) { return y > 1e-12; }))
      plot.series.push_back(std::move(series));
  }
  return plot;
}

}  // namespace

std::vector<SeriesCurve> series_curves(const SeriesRecord& record) {
  std::vector<SeriesCurve> curves;
  const auto add = [&curves](const std::string& name, Plot plot, const std::string& caption) {
    if (std::none_of(plot.series.begin(), plot.series.end(), shows_anything)) return;
    curves.push_back({name, caption, std::move(plot)});
  };
  Plot sizes = over_time("tetrahedra");
  sizes.series = {
      series_of(record, "tetrahedra",
                [](const SeriesStep& step) { return static_cast<double>(step.run.figures.tetrahedra); }),
      series_of(record, "with interfaces", [](const SeriesStep& step) {
        return static_cast<double>(step.run.figures.interface_tetrahedra);
      })};
  sizes.y.low = 0;
  add("series-tetrahedra", std::move(sizes), "The size of the mesh over time.");
  add("series-interface-error", error_plot(record),
      "Two-sided distance between the interfaces of input and mesh over time: no point is farther than the "
      "certified error.");
  add("series-field-error", field_plot(record),
      "Mean field errors over time, as parts of each field's range over all steps.");
  add("series-volumes", material_plot(record, "volume", &LedgerRow::volume_input, &LedgerRow::volume_mesh),
      "Volumes of the materials over time: in the mesh, and dashed in the input.");
  add("series-masses", material_plot(record, "mass", &LedgerRow::mass_input, &LedgerRow::mass_mesh),
      "Masses of the materials over time: in the mesh, and dashed in the input.");
  return curves;
}

}  // namespace adamas
