
#include "cli/experiment_record.h"

namespace adamas {

Figures experiment_figures(const ExperimentRecord& record) {
  Figures figures;
  figures["title"] = record.title;
  figures["input"] = record.input;
  figures["interfaces"] = Figures::array();
  for (const auto& [pair, count] : record.triangles)
    figures["interfaces"].push_back({{"between", pair}, {"triangles", count}});
  figures["interface_mesh"] = record.interfaces.json;
  figures["mesh"] = record.last().json;
  figures["nested_errors"] = Figures::object();
  for (std::size_t f = 0; f < record.fields.size(); ++f) {
    const NestedSummary& nested = record.last().nested[f];
    figures["nested_errors"][record.fields[f].name] = {{"tetrahedra", nested.tetrahedra},
                                                       {"greatest", nested.greatest},
                                                       {"mean", nested.mean},
                                                       {"corrected_greatest", nested.corrected_greatest},
                                                       {"corrected_mean", nested.corrected_mean},
                                                       {"undefined", nested.undefined}};
  }
  figures["curve"] = Figures::array();
  for (const ExperimentRun& run : record.curve) figures["curve"].push_back(run.json);
  figures["published"] = Figures::array();
  for (const PublishedFigure& figure : record.published)
    figures["published"].push_back(
        {{"name", figure.name}, {"published", figure.published}, {"here", figure.here}});
  figures["ledger"] = Figures::array();
  for (const LedgerRow& row : record.ledger) {
    Figures entry{
        {"material", row.material}, {"volume_input", row.volume_input}, {"volume_mesh", row.volume_mesh}};
    if (!record.density.empty()) {
      entry["mass_input"] = row.mass_input;
      entry["mass_mesh"] = row.mass_mesh;
    }
    figures["ledger"].push_back(std::move(entry));
  }
  figures["seconds"] = record.seconds;
  figures["peak_memory_bytes"] = peak_memory_bytes();
  return figures;
}

}  // namespace adamas
