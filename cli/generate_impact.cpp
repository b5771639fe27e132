#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/series_options.h"
#include "cli/usage.h"
#include "core/io/multi_material_writer.h"
#include "datasets/flow/flow_output.h"
#include "datasets/flow/impact.h"

namespace adamas::cli {

using namespace datasets;
using namespace io;

namespace {

const SeriesForm kForm{".vtr", 11};

struct Options {
  std::string dimensions, box, end_time, speed;
  SeriesOutputOptions series;
};

ImpactOptions impact_options(const Options& options) {
  ImpactOptions impact;
  if (!options.dimensions.empty()) impact.cells = parse_dimensions("--dimensions", options.dimensions);
  if (!options.box.empty()) impact.box = to_box(parse_bounds("--box", options.box));
  if (!holds_impact(impact.box)) {
    wrong_usage("--box: expected x0 <= 0 < x1, y0 <= 0 < y1 and z0 < 0 < z1, found '{}'", options.box);
  }
  if (!options.speed.empty()) impact.speed = parse_positive("--speed", options.speed);
  if (impact.speed > kGreatestImpactSpeed) {
    wrong_usage("--speed: expected at most {} cm/us, found '{}'", kGreatestImpactSpeed, options.speed);
  }
  return impact;
}

/// Prints the masses and the energy at the start and at the end, and adds them to the figures.
void print_ledger(const FlowSolver<3>& flow, const FlowLedger<3>& start, Console& console, Figures& figures) {
  const FlowLedger<3> now = flow.inside();
  std::vector<std::vector<std::string>> rows{{"", "at the start", "at the end", "went out", "difference"}};
  const auto row = [&rows](const std::string& name, double before, double after, double entered) {
    rows.push_back({name, fmt::format("{:.6g}", before), fmt::format("{:.6g}", after),
                    fmt::format("{:.3g}", 0 - entered),
                    fmt::format("{:.1e}", (after - entered - before) / before)});
    return Figures{{"name", name}, {"start", before}, {"end", after}, {"entered", entered}};
  };
  figures["masses"] = Figures::array();
  for (std::size_t m = 0; m < 3; ++m) {
    Figures mass = row(flow.problem().materials[m].name, start.mass[m], now.mass[m], flow.entered().mass[m]);
    figures["masses"].push_back(std::move(mass));
  }
  figures["energy"] = row("energy", start.energy, now.energy, flow.entered().energy);
  console.table(rows);
}

void run(const Options& options, Session& session) {
  const ImpactOptions impact = impact_options(options);
  const double end = options.end_time.empty() ? kImpactTime : parse_positive("--end-time", options.end_time);
  SeriesOutput series(options.series.output, options.series.steps, end, kForm, {".vtr", ".vti", ".pvd"},
                      session.outputs);
  FlowSolver<3> flow = make_impact(impact);
  const FlowLedger<3> start = flow.inside();
  const auto make = [&](double time, Progress& progress) -> SeriesOutput::Writer {
    flow.advance_to(time, progress);
    return [data = flow_data(flow, options.series.output, kImpactUnits)](const auto& path) {
      write_multi_material_data(path, data);
    };
  };
  series.write(make, session.outputs, session.console);
  const auto& cells = impact.cells;
  Figures figures{{"dimensions", cells}, {"bytes", series.bytes()}, {"box", box_figures(impact.box)}};
  figures["speed"] = impact.speed;
  figures["times"] = series.times();
  figures["steps"] = flow.steps();
  figures["first_order_cells"] = flow.first_order_cells();
  session.console.print("Impact on {} x {} x {} cells, {:.6g} us in {} steps, {}\n", cells[0], cells[1],
                        cells[2], flow.time(), flow.steps(), bytes_text(static_cast<double>(series.bytes())));
  print_ledger(flow, start, session.console, figures);
  figures["seconds"] = session.console.seconds();
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
  session.commit();
}

}  // namespace

void add_generate_impact(const Command& generate, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command = add_command(
      generate, session, "impact", "A projectile strikes a block: a flow of three materials",
      "adamas generate impact --steps 21 -o impact.pvd", [options, &session] { run(*options, session); });
  command.add_option("--dimensions", options->dimensions, "Numbers of cells (default 32,32,52)")
      .type_name("X,Y,Z");
  command
      .add_option("--box", options->box,
                  "The domain in cm (default 0,12,0,12,-16,4.8); where x or y begins with 0, the flow is "
                  "symmetric there")
      .type_name("x0,x1,y0,y1,z0,z1");
  command
      .add_option("--end-time", options->end_time,
                  fmt::format("Time of the last data in microseconds (default {})", kImpactTime))
      .type_name("T");
  command
      .add_option(
          "--speed", options->speed,
          fmt::format("Speed of the projectile in cm per microsecond (default {})", ImpactOptions().speed))
      .type_name("V");
  add_series_output(command, ".vtr or .vti", kForm, options->series);
}

}  // namespace adamas::cli
