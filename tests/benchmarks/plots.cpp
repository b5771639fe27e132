// Draws plots of figures that the scripts have found. A file of JSON has an array of plots:
// {"title", "x", "y": labels, "logarithmic", "logarithmic_x": whether y and x are, "series": [{"name", "x",
// "y": numbers, "dashed"}]}.

#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/picture/picture_file.h"
#include "core/picture/plot.h"

namespace adamas::bench {

using namespace picture;

namespace {

PlotSeries series_of(const nlohmann::json& described) {
  PlotSeries series;
  series.name = described.at("name");
  series.x = described.at("x").get<std::vector<double>>();
  series.y = described.at("y").get<std::vector<double>>();
  series.dashed = described.value("dashed", false);
  series.markers = false;
  return series;
}

Plot plot_of(const nlohmann::json& described) {
  Plot plot;
  plot.title = described.at("title");
  plot.x.label = described.at("x");
  plot.y.label = described.at("y");
  if (described.value("logarithmic", false)) {
    plot.y.kind = AxisKind::kLogarithmic;
  } else {
    plot.y.low = 0;
  }
  if (described.value("logarithmic_x", false)) plot.x.kind = AxisKind::kLogarithmic;
  for (const auto& series : described.at("series")) plot.series.push_back(series_of(series));
  return plot;
}

void draw(const char* from, const char* to) {
  std::ifstream in(from);
  std::vector<Plot> plots;
  for (const auto& described : nlohmann::json::parse(in)) plots.push_back(plot_of(described));
  PlotOptions options;
  // Several plots stand side by side, and are viewed at half the size.
  options.width = plots.size() > 1 ? 520 : 800;
  options.height = plots.size() > 1 ? 440 : 560;
  options.font_size = 15;
  write_bytes(to, draw_plots(plots, picture_format(to), options));
}

}  // namespace
}  // namespace adamas::bench

/// Usage: bench_plots FILE PICTURE.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  adamas::bench::draw(argv[1], argv[2]);
}
