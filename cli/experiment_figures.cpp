#include "cli/experiment_figures.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "cli/resample_figures.h"
#include "cli/series_figures.h"

namespace adamas::cli {

namespace {

Figures run_figures(const ExperimentRun& run) {
  Figures figures = resample_json(run.report);
  figures["seconds"] = run.seconds;
  return figures;
}

}  // namespace

Figures experiment_figures(const ExperimentRecord& record) {
  Figures figures;
  figures["title"] = record.title;
  figures["input"] = record.input;
  figures["interfaces"] = Figures::array();
  for (const auto& [pair, count] : record.triangles)
    figures["interfaces"].push_back({{"between", pair}, {"triangles", count}});
  figures["interface_mesh"] = run_figures(record.interfaces);
  figures["mesh"] = run_figures(record.last());
  figures["nested_errors"] = Figures::object();
  for (std::size_t f = 0; f < record.fields.size(); ++f) {
    const NestedFieldErrors& nested = record.last().nested[f];
    figures["nested_errors"][record.fields[f].name] = {{"tetrahedra", nested.tetrahedra},
                                                       {"greatest", nested.greatest},
                                                       {"mean", nested.mean},
                                                       {"corrected_greatest", nested.corrected_greatest},
                                                       {"corrected_mean", nested.corrected_mean},
                                                       {"undefined", nested.undefined}};
  }
  figures["curve"] = Figures::array();
  for (const ExperimentRun& run : record.curve) figures["curve"].push_back(run_figures(run));
  figures["published"] = Figures::array();
  for (const PublishedFigure& figure : record.published)
    figures["published"].push_back(
        {{"name", figure.name}, {"published", figure.published}, {"here", figure.here}});
  figures["ledger"] = Figures::array();
  for (const MaterialBalance& row : record.balance) {
    Figures entry{
        {"material", row.material}, {"volume_input", row.volume_input}, {"volume_mesh", row.volume_mesh}};
    if (!record.density.empty()) {
      entry["mass_input"] = row.mass_input;
      entry["mass_mesh"] = row.mass_mesh;
    }
    figures["ledger"].push_back(std::move(entry));
  }
  figures["steps"] = record.series ? series_figures(*record.series) : Figures(nullptr);
  if (record.series) figures["damaged_steps"] = damaged_steps(*record.series);
  return figures;
}

}  // namespace adamas::cli
