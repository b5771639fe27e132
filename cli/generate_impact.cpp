#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/usage_error.h"
#include "core/io/multi_material_writer.h"
#include "core/io/series_file.h"
#include "datasets/flow/flow_output.h"
#include "datasets/flow/impact.h"

namespace adamas {

namespace {

constexpr std::size_t kDefaultSteps = 11;
/// A greater number of files is taken for a typing error.
constexpr std::size_t kMostSteps = 1000;

/// The files with the states of a flow: either one file with the last state, or a series F.pvd with
/// F_0000.vtr, F_0001.vtr, ... beside it, which are evenly spaced in time from the start to the end.
class FlowSeries {
 public:
  /// Declares the outputs. `steps` is the value of --steps, or empty. Throws UsageError and Error.
  FlowSeries(std::string output, const std::string& steps, double end, OutputSet& outputs);

  /// Advances the flow to each of the times and writes its state there.
  template <std::size_t N>
  void write(FlowSolver<N>& flow, const FlowUnits& units, Session& session) {
    for (std::size_t i = 0; i < files_.size(); ++i) {
      flow.advance_to(times_[i], session.console, times_.back());
      session.console.step("writing " + files_[i], times_[i] / times_.back());
      const MultiMaterialData data = flow_data(flow, output_, units);
      session.outputs.write(files_[i], [&data](const auto& path) { write_multi_material_data(path, data); });
      bytes_ += session.outputs.bytes(files_[i]);
    }
    finish(session.outputs);
  }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// The bytes of all files together, once they are written.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  void finish(OutputSet& outputs);

  std::string output_;
  bool is_series_ = false;
  std::vector<std::string> files_;
  std::vector<double> times_;
  std::size_t bytes_ = 0;
};

FlowSeries::FlowSeries(std::string output, const std::string& steps, double end, OutputSet& outputs)
    : output_(std::move(output)) {
  outputs.declare("-o", output_, {".vtr", ".vti", ".pvd"});
  std::filesystem::path name = output_;
  std::string extension = name.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  is_series_ = extension == ".pvd";
  if (!is_series_) {
    if (!steps.empty()) wrong_usage("--steps: expected a series as well, -o F.pvd, found '-o {}'", output_);
    files_ = {output_};
    times_ = {end};
    return;
  }
  const std::size_t count = steps.empty() ? kDefaultSteps : parse_count("--steps", steps, 2);
  if (count > kMostSteps) wrong_usage("--steps: expected at most {}, found {}", kMostSteps, steps);
  const std::string stem = name.stem().string();
  for (std::size_t i = 0; i < count; ++i) {
    files_.push_back(name.replace_filename(fmt::format("{}_{:04}.vtr", stem, i)).string());
    outputs.declare("-o", files_.back(), {".vtr"});
    times_.push_back(end * static_cast<double>(i) / static_cast<double>(count - 1));
  }
}

void FlowSeries::finish(OutputSet& outputs) {
  if (!is_series_) return;
  std::vector<SeriesEntry> entries;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    entries.push_back({times_[i], std::filesystem::path(files_[i]).filename().string()});
  }
  outputs.write(output_, [&entries](const auto& path) { write_series(path, entries); });
  bytes_ += outputs.bytes(output_);
}

struct Options {
  std::string dimensions, box, steps, end_time, speed, output;
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
  FlowSeries series(options.output, options.steps, end, session.outputs);
  FlowSolver<3> flow = make_impact(impact);
  const FlowLedger<3> start = flow.inside();
  series.write(flow, kImpactUnits, session);
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
  session.outputs.commit();
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
  command
      .add_option("--steps", options->steps,
                  "How many data sets a series has, the first at the start (default 11)")
      .type_name("N");
  command.add_option("-o,--output", options->output, "The last data: .vtr or .vti; or a series: .pvd")
      .required()
      .type_name("FILE");
}

}  // namespace adamas
