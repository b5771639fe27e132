#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "adamas/generated_files.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/series_options.h"
#include "cli/usage.h"
#include "cli/volume_options.h"

namespace adamas::cli {

namespace {

const SeriesForm kForm{".vti", 60};

struct Options {
  MixingOptions mixing;
  double end = kMixingTime;
  SampleType type = SampleType::kUint8;
  SeriesOutputOptions series;
};

std::array<std::size_t, 3> parse_cells(const std::string& option, const std::string& text) {
  const std::array<std::size_t, 3> cells = parse_dimensions(option, text);
  if (cells[2] < kFewestMixingCells)
    wrong_usage("{}: expected at least {} samples along z, where the shock goes, found '{}'", option,
                kFewestMixingCells, text);
  return cells;
}

double parse_mach(const std::string& option, const std::string& text) {
  const double mach = parse_positive(option, text);
  if (!(mach > 1 && mach <= kGreatestMixingMach))
    wrong_usage("{}: expected a number above 1 and up to {}, found '{}'", option, kGreatestMixingMach, text);
  return mach;
}

/// Prints the scale of the fields' samples, and adds it to the figures.
void print_fields(const std::vector<SampledField>& fields, Console& console, Figures& figures) {
  std::vector<std::vector<std::string>> rows{
      {"", "unit", "least", "greatest", "slope", "intercept", "cut off"}};
  figures["fields"] = Figures::array();
  for (const SampledField& field : fields) {
    rows.push_back({field.name, field.unit, fmt::format("{:.6g}", field.least),
                    fmt::format("{:.6g}", field.greatest), fmt::format("{:.6g}", field.slope),
                    fmt::format("{:.6g}", field.intercept), fmt::format("{}", field.cut_off)});
    figures["fields"].push_back({{"name", field.name},
                                 {"unit", field.unit},
                                 {"slope", field.slope},
                                 {"intercept", field.intercept},
                                 {"least", field.least},
                                 {"greatest", field.greatest},
                                 {"cut_off", field.cut_off}});
  }
  console.table(rows);
}

/// Returns the mass of each material at the start and at the end, and the mass that has entered.
Figures mass_figures(const FlowState& flow) {
  Figures masses = Figures::array();
  for (std::size_t m = 0; m < flow.materials.size(); ++m) {
    masses.push_back({{"name", flow.materials[m]},
                      {"start", flow.start.masses[m]},
                      {"end", flow.inside.masses[m]},
                      {"entered", flow.entered.masses[m]}});
  }
  return masses;
}

void run(const Options& options, Session& session) {
  const MixingOptions& mixing = options.mixing;
  SeriesOutput series(options.series.output, options.series.steps, options.end, kForm, {".vti", ".pvd"},
                      session.outputs);
  MixingSimulation flow(mixing, options.type);
  write_flow(flow, series, session.outputs, session.console);
  const FlowState state = flow.state();
  const auto& n = mixing.cells;
  const std::vector<double>& times = series.times();
  Figures figures{{"dimensions", n}, {"bytes", series.bytes()}, {"steps", times.size()}};
  figures["seconds_per_step"] = times.size() > 1 ? times[1] : times[0];
  figures["times"] = times;
  figures["type"] = sample_name(options.type);
  figures["seed"] = mixing.seed;
  figures["mach"] = mixing.mach;
  figures["spacing"] = place_figures(flow.grid().spacing);
  figures["solver_steps"] = state.steps;
  figures["first_order_cells"] = state.first_order_cells;
  session.console.print("Mixing in {} x {} x {} samples, {}, {:.6g} s in {} steps, {}\n", n[0], n[1], n[2],
                        sample_name(options.type), state.time, state.steps,
                        bytes_text(static_cast<double>(series.bytes())));
  print_fields(flow.fields(), session.console, figures);
  figures["masses"] = mass_figures(state);
  add_costs(figures, session.console);
  write_figures(figures, session);
  session.commit();
}

}  // namespace

void add_generate_mixing(const Command& generate, Session& session) {
  const auto [command, options] =
      add_command(generate, session, "mixing", "A shock through a rippled interface of two gases, as volumes",
                  "adamas generate mixing --dimensions 128 --steps 100 -o mixing.pvd", run);
  MixingOptions& mixing = options.mixing;
  command.add_value("--dimensions", "X,Y,Z",
                    "Numbers of samples (default 64); the shock goes along z, which is 0.1 m long",
                    mixing.cells, parse_cells);
  command.add_value("--seed", "N", "Which ripples (default 0)", mixing.seed, parse_count_from_0);
  command.add_value("--mach", "M",
                    fmt::format("Mach number of the shock, up to {} (default {})", kGreatestMixingMach,
                                MixingOptions().mach),
                    mixing.mach, parse_mach);
  command.add_value("--end-time", "T",
                    fmt::format("Time of the last data in seconds (default {})", kMixingTime), options.end,
                    parse_positive);
  command.add_choice("--type", "Of the samples; whole numbers have one scale for all steps", options.type,
                     made_types(), "uint8");
  add_series_output(command, ".vti", kForm, options.series);
}

}  // namespace adamas::cli
