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
#include "cli/volume_options.h"
#include "core/io/volume_writer.h"
#include "datasets/flow/mixing_samples.h"

namespace adamas::cli {

using namespace datasets;
using namespace io;

namespace {

const SeriesForm kForm{".vti", 60};

struct Options {
  std::string dimensions, seed, mach, end_time, type = "uint8";
  SeriesOutputOptions series;
};

MixingOptions mixing_options(const Options& options) {
  MixingOptions mixing;
  if (!options.dimensions.empty()) mixing.cells = parse_dimensions("--dimensions", options.dimensions);
  if (mixing.cells[2] < kFewestMixingCells) {
    wrong_usage("--dimensions: expected at least {} samples along z, where the shock goes, found '{}'",
                kFewestMixingCells, options.dimensions);
  }
  if (!options.seed.empty()) mixing.seed = parse_count("--seed", options.seed, 0);
  if (!options.mach.empty()) mixing.mach = parse_positive("--mach", options.mach);
  if (!(mixing.mach > 1 && mixing.mach <= kGreatestMixingMach)) {
    wrong_usage("--mach: expected a number above 1 and up to {}, found '{}'", kGreatestMixingMach,
                options.mach);
  }
  return mixing;
}

std::vector<PointArray> arrays_of(const MixingSamples& samples) {
  std::vector<PointArray> arrays;
  const std::size_t plane = samples.grid().plane_bytes();
  for (const MixingField& field : samples.fields()) {
    arrays.push_back(
        {field.name, field.scale.slope(), field.scale.intercept(),
         [plane, &field](std::uint64_t k) { return std::span(field.samples).subspan(k * plane, plane); }});
  }
  return arrays;
}

/// Prints what the fields' samples stand for, and adds it to the figures.
void print_fields(const MixingSamples& samples, Console& console, Figures& figures) {
  std::vector<std::vector<std::string>> rows{
      {"", "unit", "least", "greatest", "slope", "intercept", "cut off"}};
  figures["fields"] = Figures::array();
  for (const MixingField& field : samples.fields()) {
    const double slope = field.scale.slope(), intercept = field.scale.intercept();
    rows.push_back({field.name, field.unit, fmt::format("{:.6g}", field.least),
                    fmt::format("{:.6g}", field.greatest), fmt::format("{:.6g}", slope),
                    fmt::format("{:.6g}", intercept), fmt::format("{}", field.cut_off)});
    figures["fields"].push_back({{"name", field.name},
                                 {"unit", field.unit},
                                 {"slope", slope},
                                 {"intercept", intercept},
                                 {"least", field.least},
                                 {"greatest", field.greatest},
                                 {"cut_off", field.cut_off}});
  }
  console.table(rows);
}

/// How far masses and energy are from what was there and what passed the ends, as parts.
Figures conservation_figures(const FlowSolver<2>& flow, const FlowLedger<2>& start) {
  const FlowLedger<2> now = flow.inside();
  Figures masses = Figures::array();
  for (std::size_t m = 0; m < 2; ++m) {
    masses.push_back({{"name", flow.problem().materials[m].name},
                      {"start", start.mass[m]},
                      {"end", now.mass[m]},
                      {"entered", flow.entered().mass[m]}});
  }
  return masses;
}

void run(const Options& options, Session& session) {
  const MixingOptions mixing = mixing_options(options);
  const double end = options.end_time.empty() ? kMixingTime : parse_positive("--end-time", options.end_time);
  SeriesOutput series(options.series.output, options.series.steps, end, kForm, {".vti", ".pvd"},
                      session.outputs);
  MixingFlow moving(mixing);
  const FlowSolver<2>& flow = moving.solver();
  const FlowLedger<2> start = flow.inside();
  MixingSamples samples(mixing.cells, mixing.mach, parse_sample_type(options.type));
  const auto make = [&](double time, Progress& progress) -> SeriesOutput::Writer {
    moving.advance_to(time, progress);
    samples.update(flow);
    return [&samples](const auto& path) { write_point_arrays(path, samples.grid(), arrays_of(samples)); };
  };
  series.write(make, session.outputs, session.console);
  const auto& n = mixing.cells;
  const VolumeGrid& grid = samples.grid();
  const std::vector<double>& times = series.times();
  Figures figures{{"dimensions", n}, {"bytes", series.bytes()}, {"steps", times.size()}};
  figures["seconds_per_step"] = times.size() > 1 ? times[1] : times[0];
  figures["times"] = times;
  figures["type"] = options.type;
  figures["seed"] = mixing.seed;
  figures["mach"] = mixing.mach;
  figures["spacing"] = {grid.spacing.x, grid.spacing.y, grid.spacing.z};
  figures["solver_steps"] = flow.steps();
  figures["first_order_cells"] = flow.first_order_cells();
  session.console.print("Mixing in {} x {} x {} samples, {}, {:.6g} s in {} steps, {}\n", n[0], n[1], n[2],
                        options.type, flow.time(), flow.steps(),
                        bytes_text(static_cast<double>(series.bytes())));
  print_fields(samples, session.console, figures);
  figures["masses"] = conservation_figures(flow, start);
  figures["seconds"] = session.console.seconds();
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
  session.commit();
}

}  // namespace

void add_generate_mixing(const Command& generate, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(generate, session, "mixing", "A shock through a rippled interface of two gases, as volumes",
                  "adamas generate mixing --dimensions 128 --steps 100 -o mixing.pvd",
                  [options, &session] { run(*options, session); });
  command
      .add_option("--dimensions", options->dimensions,
                  "Numbers of samples (default 64); the shock goes along z, which is 0.1 m long")
      .type_name("X,Y,Z");
  command.add_option("--seed", options->seed, "Which ripples (default 0)").type_name("N");
  command
      .add_option("--mach", options->mach,
                  fmt::format("Mach number of the shock, up to {} (default {})", kGreatestMixingMach,
                              MixingOptions().mach))
      .type_name("M");
  command
      .add_option("--end-time", options->end_time,
                  fmt::format("Time of the last data in seconds (default {})", kMixingTime))
      .type_name("T");
  add_sample_type(command, options->type, "Of the samples; whole numbers have one scale for all steps")
      .show_default();
  add_series_output(command, ".vti", kForm, options->series);
}

}  // namespace adamas::cli
