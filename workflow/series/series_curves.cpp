#include "workflow/series/series_curves.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "adamas/file_names.h"
#include "adamas/files.h"
#include "core/io/output_stream.h"
#include "core/picture/material_colours.h"
#include "workflow/series/series_tables.h"

namespace adamas {

namespace workflow {

using namespace picture;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// Curves of more materials would not be legible.
constexpr std::size_t kMostMaterials = 12;

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

/// Plots two lines for each material in its colour and with its own markers: dashed and open for the input,
/// filled for the mesh; both are relative to the greatest value that the input ever has, so that small
/// materials are visible too.
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
    const auto of = [&record, m, greatest](std::string name, double MaterialBalance::*value) {
      PlotSeries series = series_of(record, std::move(name), [m, value, greatest](const ResampledStep& step) {
        return step.balance[m].*value / greatest;
      });
      series.colour = material_colour(m);
      series.marker = m;
      return series;
    };
    PlotSeries of_input = of("", input);
    of_input.dashed = true;
    of_input.open = true;
    plot.series.push_back(std::move(of_input));
    plot.series.push_back(of(materials[m].material, mesh));
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

/// Plots the errors of fields. Fields that the mesh reproduces exactly appear only in the legend.
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
  std::vector<picture::Plot> plots;
  for (workflow::SeriesCurve& curve : workflow::series_curves(series)) plots.push_back(std::move(curve.plot));
  picture::write_bytes(path, picture::draw_plots(plots, picture::picture_format(path), {.columns = 2}));
}

}  // namespace adamas
