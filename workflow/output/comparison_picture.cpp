#include "adamas/comparison_picture.h"

#include <array>
#include <cmath>
#include <limits>

#include "core/picture/picture_file.h"
#include "core/picture/plot.h"

namespace adamas {

using namespace picture;

namespace {

/// The kinds of meshes whose distance is measured, in the order of the legend.
constexpr std::array kJoined{MeshKind::kOwn,
                             MeshKind::kOwnCut,
                             MeshKind::kTetGen,
                             MeshKind::kMesh3,
                             MeshKind::kMesh3Optimised,
                             MeshKind::kTetGenSimplified,
                             MeshKind::kMesh3Simplified,
                             MeshKind::kMesh3Labels};

/// Makes one diagram: a line for each generator with a measured distance, a horizontal line for one without.
Plot make_plot(const std::vector<ComparisonRow>& rows, const std::string& title, const std::string& label,
               double (*value)(const ComparisonRow&)) {
  Plot plot;
  plot.title = title;
  plot.x = {.label = "measured two-sided distance of interfaces", .kind = AxisKind::kLogarithmic};
  plot.y = {.label = label, .kind = AxisKind::kLogarithmic};
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  for (const MeshKind kind : kJoined) {
    PlotSeries series{.name = mesh_name(kind)};
    for (const ComparisonRow& row : rows) {
      const double distance = row.distance();
      if (row.kind != kind || !row.failure.empty() || !std::isfinite(distance) || !(distance > 0)) continue;
      series.x.push_back(distance);
      series.y.push_back(value(row));
      nearest = std::min(nearest, distance), farthest = std::max(farthest, distance);
    }
    if (!series.x.empty()) plot.series.push_back(series);
  }
  for (const ComparisonRow& row : rows) {
    if (row.kind != MeshKind::kTetGenUntouched || !row.failure.empty() || !(farthest > 0)) continue;
    plot.series.push_back({.name = mesh_name(row.kind) + ", distance 0",
                           .x = {nearest, farthest},
                           .y = {value(row), value(row)},
                           .markers = false,
                           .dashed = true});
  }
  return plot;
}

}  // namespace

void write_comparison_picture(const std::filesystem::path& path, const std::vector<ComparisonRow>& rows,
                              const std::string& title) {
  const std::array plots{
      make_plot(rows, title + ": tetrahedra", "tetrahedra",
                [](const ComparisonRow& row) { return static_cast<double>(row.tetrahedra); }),
      make_plot(rows, title + ": seconds", "seconds", [](const ComparisonRow& row) { return row.seconds; })};
  write_bytes(path, draw_plots(plots, picture_format(path), {.width = 1000, .height = 800}));
}

}  // namespace adamas
