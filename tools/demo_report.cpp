// Resamples multi-material files within a series of interface errors and writes pictures, curves and figures
// as one HTML report: demo_report OUTPUT (FILE FIELD PLANE WINDOW FINEST)...

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "core/io/multi_material_reader.h"
#include "core/picture/html_report.h"
#include "core/picture/plot.h"
#include "interfaces/grid_source.h"
#include "tools/demo_pictures.h"
#include "tools/demo_run.h"

namespace adamas::demo {
namespace {

/// Interface errors of the curve, in relation to the finest; pictures are of the last.
constexpr std::array kErrors{4.0, 2.8, 2.0, 1.4, 1.0};
constexpr std::string_view kPerVolume = "/volume";

struct Job {
  std::filesystem::path file;
  std::string field;
  Plane plane;
  std::optional<Box2> window;  ///< a part of the plane that is shown enlarged
  double finest;               ///< interface error, as a part of the domain's diagonal
};

/// "all", or "x0,x1,y0,y1" in the coordinates of the slice.
std::optional<Box2> parse_window(const std::string& text) {
  if (text == "all") return std::nullopt;
  Box2 window;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf", &window.min.x, &window.max.x, &window.min.y,
                  &window.max.y) != 4 ||
      window.empty()) {
    fail("window: expected 'all' or x0,x1,y0,y1, found '{}'", text);
  }
  return window;
}

/// "0.5%" as 0.005.
double parse_part(const std::string& text) {
  double percent = 0;
  char sign = 0;
  if (std::sscanf(text.c_str(), "%lf%c", &percent, &sign) != 2 || sign != '%' || !(percent > 0)) {
    fail("finest error: expected a part of the diagonal as 0.5%, found '{}'", text);
  }
  return percent / 100;
}

MultiMaterialData read(Job& job) {
  MaterialDataOptions options;
  if (job.field.ends_with(kPerVolume)) {
    job.field.resize(job.field.size() - kPerVolume.size());
    options.extensive.push_back(job.field);
  }
  return read_multi_material_data(job.file, options);
}

std::string percent(double part) { return fmt::format("{:.3g} %", 100 * part); }

double change(double from, double to) { return from > 0 ? (to - from) / from : 0; }

Plot error_plot(const std::vector<RunFigures>& runs) {
  Plot plot;
  plot.x = {"tetrahedra", AxisKind::kLogarithmic};
  plot.y = {"interface error", AxisKind::kLogarithmic};
  plot.series = {{.name = "wanted", .markers = false, .dashed = true},
                 {.name = "certified"},
                 {.name = "attained (lower bound)"}};
  for (const RunFigures& run : runs) {
    const auto count = static_cast<double>(run.tetrahedra);
    for (PlotSeries& series : plot.series) series.x.push_back(count);
    plot.series[0].y.push_back(run.target);
    plot.series[1].y.push_back(run.distance ? run.distance->upper : 0);
    plot.series[2].y.push_back(run.distance ? run.distance->lower : 0);
  }
  return plot;
}

Plot field_plot(const std::vector<RunFigures>& runs, const std::vector<FieldInfo>& fields) {
  Plot plot;
  plot.x = {"tetrahedra", AxisKind::kLogarithmic};
  plot.y = {"mean field error / range", AxisKind::kLogarithmic};
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const double range = fields[f].max - fields[f].min;
    PlotSeries series{.name = fields[f].name};
    for (const RunFigures& run : runs) {
      const FieldError& error = run.fields[f];
      series.x.push_back(static_cast<double>(run.tetrahedra));
      series.y.push_back(error.count > 0 && range > 0 ? error.sum / static_cast<double>(error.count) / range
                                                      : 0);
    }
    // A field that comes back exactly would stretch the axis down to round-off.
    if (*std::max_element(series.y.begin(), series.y.end()) > 1e-12) plot.series.push_back(std::move(series));
  }
  return plot;
}

ReportTable runs_table(const std::vector<RunFigures>& runs) {
  ReportTable table{"Runs, from coarse to fine",
                    {"wanted interface error", "certified", "attained", "tetrahedra", "with interfaces",
                     "vertices", "seconds"},
                    {}};
  for (const RunFigures& run : runs) {
    table.rows.push_back({fmt::format("{:.4g}", run.target),
                          run.distance ? fmt::format("{:.4g}", run.distance->upper) : "",
                          run.distance ? fmt::format("{:.4g}", run.distance->lower) : "",
                          fmt::format("{}", run.tetrahedra), fmt::format("{}", run.interface_tetrahedra),
                          fmt::format("{}", run.vertices), fmt::format("{:.2f}", run.seconds)});
  }
  return table;
}

ReportTable volume_table(const ResamplingSource& source, const RunFigures& run) {
  ReportTable table{"Volumes of the materials", {"material", "input", "mesh", "change"}, {}};
  for (MaterialId m(0); m.value < source.materials.size(); ++m.value) {
    table.rows.push_back({source.materials[m], fmt::format("{:.6g}", source.volumes[m]),
                          fmt::format("{:.6g}", run.volumes[m]),
                          percent(change(source.volumes[m], run.volumes[m]))});
  }
  return table;
}

ReportTable field_table(const std::vector<FieldInfo>& fields, const RunFigures& run) {
  ReportTable table{"Field errors at the input's own sites; no field error was asked for",
                    {"field", "unit", "range", "greatest", "mean"},
                    {}};
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const FieldError& error = run.fields[f];
    const double mean = error.count > 0 ? error.sum / static_cast<double>(error.count) : 0;
    table.rows.push_back({fields[f].name, fields[f].unit,
                          fmt::format("{:.4g} to {:.4g}", fields[f].min, fields[f].max),
                          fmt::format("{:.4g}", error.max), fmt::format("{:.4g}", mean)});
  }
  return table;
}

/// Puts a picture into the report and beside it.
void add_picture(HtmlReport& report, const std::filesystem::path& path, const std::string& png,
                 std::string_view caption) {
  write_bytes(path, png);
  report.picture(png, PictureFormat::kPng, caption);
}

void add_slices(HtmlReport& report, const MultiMaterialData& data, const ResampledMesh& mesh,
                const InterfaceMesh& original, const Job& job, const std::filesystem::path& path) {
  const DemoSlices slices(data, mesh, original, job.plane, job.field);
  add_picture(
      report, path, slices.png({}),
      fmt::format("The plane {}: the input; plain linear interpolation in the cells of the mesh, which "
                  "smears across the interfaces; each material's own field up to its interfaces.",
                  to_string(job.plane)));
  if (!job.window) return;
  std::filesystem::path detail = path;
  detail.replace_filename(path.stem().string() + "-detail.png");
  add_picture(report, detail, slices.png(job.window), "A part of it, enlarged.");
}

void add_job(HtmlReport& report, Job job, const std::filesystem::path& folder) {
  const MultiMaterialData data = read(job);
  const ResamplingSource source = make_grid_source(data);
  std::vector<RunFigures> runs;
  Run run;
  for (const double factor : kErrors) {
    const double error = factor * job.finest;
    run = resample(source, error * source.box.diagonal());
    runs.push_back(run.figures);
    std::fprintf(stderr, "%s: error %s of the diagonal, %zu tetrahedra, %.2f s\n",
                 job.file.filename().c_str(), percent(error).c_str(), run.figures.tetrahedra,
                 run.figures.seconds);
  }
  const std::string stem = job.file.stem().string();
  const auto path = [&](std::string_view name) { return folder / fmt::format("{}-{}.png", stem, name); };
  const auto& fields = source.fields->fields();
  const InterfaceMesh original = input_interfaces(source);

  report.heading(job.file.filename().string());
  report.paragraph(fmt::format(
      "{} x {} x {} {}, {} materials, {} fields; {} triangles between the materials.", data.grid.sites(0),
      data.grid.sites(1), data.grid.sites(2), data.grid.centering == Centering::kCells ? "cells" : "points",
      data.materials.size(), fields.size(), original.triangles.size()));
  const RunFigures& last = runs.back();
  report.key_figures(
      {{"tetrahedra", fmt::format("{}", last.tetrahedra), ""},
       {"native elements for each",
        fmt::format("{:.1f}",
                    static_cast<double>(data.grid.site_count()) / static_cast<double>(last.tetrahedra)),
        ""},
       {"certified interface error",
        last.distance ? percent(last.distance->upper / source.box.diagonal()) : "none", "of the diagonal"},
       {"time", fmt::format("{:.2f}", last.seconds), "s"}});
  add_slices(report, data, run.mesh, original, job, path("slices"));
  add_picture(report, path("input"), interfaces_png(original, source.box, source.volumes, "", false),
              "Interfaces of the input.");
  add_picture(report, path("mesh"), interfaces_png(run.interfaces.mesh, source.box, source.volumes, "", true),
              "Interfaces of the mesh, cell by cell.");
  report.heading("Error against size", 3);
  add_picture(report, path("errors"), draw_plot(error_plot(runs), PictureFormat::kPng),
              "Two-sided distance between the interfaces of input and mesh: no point is farther than the "
              "certified error.");
  add_picture(report, path("field-errors"), draw_plot(field_plot(runs, fields), PictureFormat::kPng),
              "Mean field errors, as parts of each field's range; those at round-off are left out.");
  report.table(runs_table(runs));
  report.table(volume_table(source, last));
  report.table(field_table(fields, last));
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() < 6 || arguments.size() % 5 != 1) {
    std::fprintf(stderr, "usage: demo_report OUTPUT (FILE FIELD PLANE WINDOW FINEST)...\n");
    return 2;
  }
  const std::filesystem::path folder = arguments[0];
  HtmlReport report(
      "adamas: materials on adaptive tetrahedra",
      "Data with several materials, resampled to tetrahedral meshes within a series of errors.");
  for (std::size_t i = 1; i < arguments.size(); i += 5) {
    add_job(report,
            {arguments[i], arguments[i + 1], parse_plane(arguments[i + 2]), parse_window(arguments[i + 3]),
             parse_part(arguments[i + 4])},
            folder);
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  report.paragraph(fmt::format("Greatest memory of the whole run: {:.0f} MiB.",
                               static_cast<double>(usage.ru_maxrss) / 1024));
  report.write(folder / "report.html");
  return 0;
}

}  // namespace
}  // namespace adamas::demo

int main(int argc, char** argv) {
  try {
    return adamas::demo::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "demo_report: error: %s\n", error.what());
    return 1;
  }
}
