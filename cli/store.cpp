#include <algorithm>
#include <vector>

#include "adamas/store_files.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/store_options.h"
#include "cli/volume_options.h"

namespace adamas::cli {

namespace {

double ratio(std::uint64_t before, std::uint64_t after) {
  return after > 0 ? static_cast<double>(before) / static_cast<double>(after) : 0;
}

/// Reports the steps that this run has stored, apart from those that a store had before.
void report(const StoreReport& stored, const std::string& output, Session& session) {
  Console& console = session.console;
  const VolumeGrid& grid = stored.grid;
  const auto [nx, ny, nz] = grid.dimensions;
  const StoredBytes& bytes = stored.stored.bytes;
  const std::uint64_t added = stored.added_bytes(), steps_now = stored.steps_before + stored.steps;
  const bool is_added = stored.steps_before > 0;
  const double seconds = console.seconds();
  console.print("{} x {} x {} samples, {}{}\n", nx, ny, nz, type_text(grid.type, stored.numbers),
                stored.steps > 1 || is_added
                    ? fmt::format(", {}{}", counted(stored.steps, "step"), is_added ? " added" : "")
                    : "");
  print_store_bytes(stored.input_bytes, bytes, added, console, is_added ? "added" : "file");
  if (is_added)
    console.print("{} has {} now, {}\n", output, counted(steps_now, "step"),
                  bytes_text(static_cast<double>(stored.stored.file_bytes)));
  console.print("{} in {:.1f} s, {:.1f} M samples/s\n", counted(stored.stored.pages, "page"), seconds,
                static_cast<double>(grid.samples() * stored.steps) / seconds / 1e6);
  Figures figures{{"samples", grid.samples()},
                  {"steps", stored.steps},
                  {"dimensions", grid.dimensions},
                  {"type", sample_name(grid.type)},
                  {"number_type", to_string(stored.numbers)},
                  {"array", stored.array.empty() ? Figures() : Figures(stored.array)},
                  {"bytes_input", stored.input_bytes},
                  {"bytes_data", bytes.samples},
                  {"bytes_gradients", bytes.gradients},
                  {"bytes_errors", bytes.bounds},
                  {"bytes_remainders", bytes.remainders},
                  {"bytes_added", added},
                  {"bytes_file", stored.stored.file_bytes},
                  {"steps_file", steps_now},
                  {"ratio_data", ratio(stored.input_bytes, bytes.samples)},
                  {"ratio", ratio(stored.input_bytes, added)},
                  {"pages", stored.stored.pages},
                  {"infinite_samples", Figures::array()}};
  for (const auto& [step, samples] : stored.infinite_samples)
    figures["infinite_samples"].push_back({{"step", stored.steps_before + step}, {"samples", samples}});
  add_costs(figures, console);
  write_figures(figures, session);
}

struct Options {
  StoreRequest request;
  std::string output;
  bool no_time_smoothing = false;
};

void run(const Options& options, Session& session) {
  StoreRequest request = options.request;
  request.output = options.output;
  request.options.smooth_along_time = !options.no_time_smoothing;
  request.options.scratch = request.input.scratch;
  request.added = [&session](std::uint32_t added, std::size_t wanted) {
    session.kept = fmt::format("{} of {} were added", added, counted(wanted, "step"));
  };
  const StoreReport stored = store_files(request, session.outputs, session.console);
  if (stored.steps > 0) report(stored, options.output, session);
  session.commit();
}

/// Parses a number of an option as 32 bits; greater ones, which none of these options allows, become the
/// greatest.
std::uint32_t parse_small_count(const std::string& option, const std::string& text) {
  constexpr std::size_t kMost = ~std::uint32_t{0};
  return static_cast<std::uint32_t>(std::min(parse_count(option, text), kMost));
}

/// Adds the options that say how a store is built.
void add_build_options(const Command& command, BuildOptions& options, bool& no_time_smoothing) {
  using Prediction = BuildOptions::Prediction;
  using Smoothing = BuildOptions::Smoothing;
  command.add_choice<Prediction>(
      "--coding",
      "How samples are predicted: from all neighbours that are known, or only from the two ends of the edge "
      "whose middle they are; or not at all: samples and gradients as they are, for comparison (default "
      "interpolation; with --append that of the store)",
      options.prediction,
      {{"interpolation", Prediction::kInterpolation},
       {"split-edge", Prediction::kSplitEdge},
       {"none", Prediction::kNone}});
  command.add_flag("--gradients",
                   "Keep the directions of the samples' gradients too, smoothed, for the normals of surfaces",
                   options.gradients);
  command.add_choice<Smoothing>(
      "--smoothing",
      "How gradients are smoothed: not at all; by the first phase, which also fills regions where nothing "
      "changes; or by both (default)",
      options.smoothing,
      {{"none", Smoothing::kNone}, {"first", Smoothing::kFirstPhase}, {"both", Smoothing::kBothPhases}});
  command.add_flag("--no-time-smoothing",
                   "Of a series: smooth the gradients of each step in space alone. Otherwise those smoothed "
                   "by both phases are smoothed along time too, within a block of steps",
                   no_time_smoothing);
  command.add_value(
      "--block-steps", "N",
      "Of a series: how many steps a page has side by side in the file. Playing goes fast where "
      "they are many, looking at one step where they are few",
      options.block_steps, parse_small_count, "32");
  command.add_value(
      "--group-pages", "N",
      "Of a series: how many neighbouring pages lie together in the file step by step, a power of two up to "
      "512. With one, all steps of a page are side by side, for playing; with many, whole steps, for looking "
      "at one alone (default 1; with --append that of the store)",
      options.group_pages, parse_small_count);
}

}  // namespace

void add_store(const Command& app, Session& session) {
  const auto [command, options] =
      add_command(app, session, "store", "Preprocesses and compresses volumes, without loss, into one file",
                  "adamas store head.raw --dimensions 512,512,300 --type uint16 -o head.adm", run);
  StoreRequest& request = options.request;
  command
      .add_option(
          "input", "FILE...",
          "The volume: " + volume_endings() +
              "; with --dimensions a raw file, with --stack a pattern of its slices. Or a series: several "
              "volumes, a pattern of their names in quotes, as \"run_%04d.vti\", a .pvd, a NIfTI of several "
              "times, or with --array a group of HDF5 or a data set along four axes, the first of which is "
              "time",
          request.inputs)
      .required();
  add_volume_options(command, request.input, "--origin,--first-sample");
  add_build_options(command, request.options, options.no_time_smoothing);
  command.add_flag("--append",
                   "Add the steps behind the last one of OUTPUT, if it is there. Where the input says the "
                   "time of each, as a .pvd or HDF5 may, these are the later ones; otherwise all, as of a "
                   "NIfTI, which says only how far apart they are",
                   request.append);
  command.add_option("-o,--output", "FILE", "The store (.adm)", options.output).required();
}

}  // namespace adamas::cli
