#include <fmt/format.h>

#include <string>
#include <vector>

#include "adamas/generated_files.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/series_options.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

const SeriesForm kForm{".vtr", 11};

struct Options {
  ImpactOptions impact;
  double end = kImpactTime;
  SeriesOutputOptions series;
};

Box3 parse_impact_box(const std::string& option, const std::string& text) {
  const Box3 box = parse_box(option, text);
  if (!holds_impact(box))
    wrong_usage("{}: expected x0 <= 0 < x1, y0 <= 0 < y1 and z0 < 0 < z1, found '{}'", option, text);
  return box;
}

double parse_speed(const std::string& option, const std::string& text) {
  const double speed = parse_positive(option, text);
  if (speed > kGreatestImpactSpeed)
    wrong_usage("{}: expected at most {} cm/us, found '{}'", option, kGreatestImpactSpeed, text);
  return speed;
}

/// Prints the masses and the energy at the start and at the end, and adds them to the figures.
void print_totals(const FlowState& flow, Console& console, Figures& figures) {
  std::vector<std::vector<std::string>> rows{{"", "at the start", "at the end", "went out", "difference"}};
  const auto row = [&rows](const std::string& name, double before, double after, double entered) {
    rows.push_back({name, fmt::format("{:.6g}", before), fmt::format("{:.6g}", after),
                    fmt::format("{:.3g}", 0 - entered),
                    fmt::format("{:.1e}", (after - entered - before) / before)});
    return Figures{{"name", name}, {"start", before}, {"end", after}, {"entered", entered}};
  };
  figures["masses"] = Figures::array();
  for (std::size_t m = 0; m < flow.materials.size(); ++m) {
    Figures mass =
        row(flow.materials[m], flow.start.masses[m], flow.inside.masses[m], flow.entered.masses[m]);
    figures["masses"].push_back(std::move(mass));
  }
  figures["energy"] = row("energy", flow.start.energy, flow.inside.energy, flow.entered.energy);
  console.table(rows);
}

void run(const Options& options, Session& session) {
  const ImpactOptions& impact = options.impact;
  SeriesOutput series(options.series.output, options.series.steps, options.end, kForm,
                      {".vtr", ".vti", ".pvd"}, session.outputs);
  ImpactSimulation flow(impact);
  write_flow(flow, series, session.outputs, session.console);
  const FlowState state = flow.state();
  const auto& cells = impact.cells;
  Figures figures{{"dimensions", cells}, {"bytes", series.bytes()}, {"box", box_figures(impact.box)}};
  figures["speed"] = impact.speed;
  figures["times"] = series.times();
  figures["steps"] = state.steps;
  figures["first_order_cells"] = state.first_order_cells;
  session.console.print("Impact on {} x {} x {} cells, {:.6g} us in {} steps, {}\n", cells[0], cells[1],
                        cells[2], state.time, state.steps, bytes_text(static_cast<double>(series.bytes())));
  print_totals(state, session.console, figures);
  add_costs(figures, session.console);
  write_figures(figures, session);
  session.commit();
}

}  // namespace

void add_generate_impact(const Command& generate, Session& session) {
  const auto [command, options] =
      add_command(generate, session, "impact", "A projectile strikes a block: a flow of three materials",
                  "adamas generate impact --steps 21 -o impact.pvd", run);
  ImpactOptions& impact = options.impact;
  command.add_value("--dimensions", "X,Y,Z", "Numbers of cells (default 32,32,52)", impact.cells,
                    parse_dimensions);
  command.add_value("--box", "x0,x1,y0,y1,z0,z1",
                    "The domain in cm (default 0,12,0,12,-16,4.8); where x or y begins with 0, the flow is "
                    "symmetric there",
                    impact.box, parse_impact_box);
  command.add_value("--end-time", "T",
                    fmt::format("Time of the last data in microseconds (default {})", kImpactTime),
                    options.end, parse_positive);
  command.add_value(
      "--speed", "V",
      fmt::format("Speed of the projectile in cm per microsecond (default {})", ImpactOptions().speed),
      impact.speed, parse_speed);
  add_series_output(command, ".vtr or .vti", kForm, options.series);
}

}  // namespace adamas::cli
