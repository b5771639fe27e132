#include <bit>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/command.h"
#include "cli/data_summary.h"
#include "cli/figures.h"
#include "cli/growing_store.h"
#include "cli/option_values.h"
#include "cli/stored_steps.h"
#include "cli/usage.h"
#include "cli/volume_options.h"
#include "core/io/input_formats.h"
#include "isosurface/storage/store_file.h"
#include "timevarying/series_builder.h"

namespace adamas::cli {

using namespace io;
using namespace isosurface;
using namespace timevarying;

namespace {

struct Options {
  std::vector<std::string> inputs;
  VolumeInput input;
  std::string coding, block_steps = "32", group_pages, smoothing, output;
  bool gradients = false, append = false, no_time_smoothing = false;
};

double ratio(std::uint64_t before, std::uint64_t after) {
  return after > 0 ? static_cast<double>(before) / static_cast<double>(after) : 0;
}

/// What of a store was there before steps were added.
struct Before {
  std::uint64_t steps = 0, bytes = 0;
};

/// Of the steps that this run has stored; what a store had before is told apart.
void report(const StoredSteps& steps, const StoreFigures& store, const Before& before,
            const std::string& output, Session& session) {
  Console& console = session.console;
  const VolumeGrid& grid = steps.grid();
  const auto [nx, ny, nz] = grid.dimensions;
  const std::uint64_t input = steps.input_bytes(), added = store.file_bytes - before.bytes;
  const bool is_added = before.steps > 0;
  const double seconds = console.seconds();
  console.print("{} x {} x {} samples, {}{}\n", nx, ny, nz, sample_name(grid.type),
                steps.count() > 1 || is_added
                    ? fmt::format(", {}{}", counted(steps.count(), "step"), is_added ? " added" : "")
                    : "");
  print_store_bytes(input, store.bytes, added, console, is_added ? "added" : "file");
  if (is_added)
    console.print("{} has {} now, {}\n", output, counted(before.steps + steps.count(), "step"),
                  bytes_text(static_cast<double>(store.file_bytes)));
  console.print("{} in {:.1f} s, {:.1f} M samples/s\n", counted(store.pages, "page"), seconds,
                static_cast<double>(grid.samples() * steps.count()) / seconds / 1e6);
  Figures figures{{"samples", grid.samples()},
                  {"steps", steps.count()},
                  {"dimensions", grid.dimensions},
                  {"type", sample_name(grid.type)},
                  {"array", steps.array().empty() ? Figures() : Figures(steps.array())},
                  {"bytes_input", input},
                  {"bytes_data", store.bytes.samples},
                  {"bytes_gradients", store.bytes.gradients},
                  {"bytes_errors", store.bytes.bounds},
                  {"bytes_added", added},
                  {"bytes_file", store.file_bytes},
                  {"steps_file", before.steps + steps.count()},
                  {"ratio_data", ratio(input, store.bytes.samples)},
                  {"ratio", ratio(input, added)},
                  {"pages", store.pages},
                  {"infinite_samples", Figures::array()},
                  {"seconds", seconds},
                  {"peak_memory_bytes", peak_memory_bytes()}};
  for (const auto& [step, samples] : steps.infinite_samples())
    figures["infinite_samples"].push_back({{"step", before.steps + step}, {"samples", samples}});
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
}

StoreOptions store_options(const Options& options) {
  StoreOptions store;
  if (options.coding == "split-edge") store.coding = SampleCoding::kSplitEdge;
  if (options.coding == "none") store.coding = SampleCoding::kPlain;
  if (!options.smoothing.empty() && !options.gradients)
    wrong_usage("--smoothing: expected with --gradients, which are what is smoothed");
  store.gradients = options.gradients;
  if (options.smoothing == "none") store.smoothing.reset();
  if (options.smoothing == "first") store.smoothing->constrained_rounds = 0;
  if (options.no_time_smoothing) {
    if (!options.gradients || !store.smoothing || !store.smoothing->is_along_time())
      wrong_usage("--no-time-smoothing: expected with --gradients that are smoothed by both phases");
    store.smoothing->time_rounds = 0;
  }
  if (!options.input.scratch.empty()) store.scratch = options.input.scratch;
  const std::size_t block_steps = parse_count("--block-steps", options.block_steps, 1);
  if (block_steps > kMostBlockSteps)
    wrong_usage("--block-steps: expected from 1 to {}, found {}", kMostBlockSteps, options.block_steps);
  store.block_steps = static_cast<std::uint32_t>(block_steps);
  if (options.group_pages.empty()) return store;
  const std::size_t group_pages = parse_count("--group-pages", options.group_pages, 1);
  if (group_pages > kMostGroupPages || !std::has_single_bit(group_pages))
    wrong_usage("--group-pages: expected a power of two from 1 to {}, found {}", kMostGroupPages,
                options.group_pages);
  store.group_pages = static_cast<std::uint32_t>(group_pages);
  return store;
}

AskedOfStore asked_of_store(const Options& options, const StoreOptions& store) {
  AskedOfStore asked{{}, {}, options.gradients};
  if (!options.coding.empty()) asked.coding = store.coding;
  if (!options.group_pages.empty()) asked.group_pages = store.group_pages;
  return asked;
}

/// The store is input and output: it stays whole, whatever becomes of what is added.
void append(const Options& options, InputSteps input, Session& session) {
  const StoreOptions how = store_options(options);
  GrowingStore store(options.output);
  store.check(asked_of_store(options, how));
  const std::string name = options.inputs.size() == 1
                               ? options.inputs[0]
                               : fmt::format("{} and {} more", options.inputs[0], options.inputs.size() - 1);
  std::vector<InputStep> later = store.later_steps(std::move(input), name, session);
  if (later.empty()) return;
  const std::string first = later.front().name;
  StoredSteps steps(std::move(later), session);
  if (steps.grid() != store.grid()) refuse_grid(first, steps.grid(), options.output, store.grid());
  const StoreFigures figures = store.add(steps, how, session);
  steps.finish();
  report(steps, figures, {store.steps(), store.bytes()}, options.output, session);
}

void run(const Options& options, Session& session) {
  InputSteps input = find_input_steps(options.inputs, options.input);
  if (!input.remark.empty()) session.console.note("{}", input.remark);
  std::error_code unknown;
  if (options.append && std::filesystem::exists(options.output, unknown)) {
    append(options, std::move(input), session);
    session.commit();
    return;
  }
  session.outputs.declare("-o", options.output, {".adm"});
  const StoreOptions store = store_options(options);
  StoredSteps steps(std::move(input.steps), session);
  StoreFigures figures;
  session.outputs.write(options.output, [&](const auto& path) {
    figures = build_series(path, options.output, steps.source(), store, session.console);
  });
  steps.finish();
  if (options.append && std::filesystem::exists(options.output, unknown))
    fail("{}: expected no store there, as when this run began, found one that was made meanwhile",
         options.output);
  report(steps, figures, {}, options.output, session);
  session.commit();
}

}  // namespace

void add_store(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(app, session, "store", "Preprocesses and compresses volumes, without loss, into one file",
                  "adamas store head.raw --dimensions 512,512,300 --type uint16 -o head.adm",
                  [options, &session] { run(*options, session); });
  command
      .add_option(
          "input", options->inputs,
          "The volume: " + list_volume_endings("or") +
              "; with --dimensions a raw file, with --stack a pattern of its slices. Or a series: several "
              "volumes, a pattern of their names in quotes, as \"run_%04d.vti\", a .pvd, a NIfTI of several "
              "times, or "
              "with --array a group of HDF5 or a data set along four axes, the first of which is time")
      .required()
      .type_name("FILE...");
  add_volume_options(command, options->input, "--origin,--first-sample");
  command
      .add_option("--coding", options->coding,
                  "How samples are predicted: from all neighbours that are known, or only from the two ends "
                  "of the edge whose middle they are; or not at all: samples and gradients as they are, for "
                  "comparison (default interpolation; with --append that of the store)")
      .one_of({"interpolation", "split-edge", "none"});
  command.add_flag(
      "--gradients", options->gradients,
      "Keep the directions of the samples' gradients too, smoothed, for the normals of surfaces");
  command
      .add_option(
          "--smoothing", options->smoothing,
          "How gradients are smoothed: not at all; by the first phase, which also fills regions where "
          "nothing changes; or by both (default)")
      .one_of({"none", "first", "both"});
  command.add_flag(
      "--no-time-smoothing", options->no_time_smoothing,
      "Of a series: smooth the gradients of each step in space alone. Otherwise those smoothed by "
      "both phases are smoothed along time too, within a block of steps");
  command
      .add_option("--block-steps", options->block_steps,
                  "Of a series: how many steps a page has side by side in the file. Playing goes fast where "
                  "they are many, looking at one step where they are few")
      .type_name("N")
      .show_default();
  command
      .add_option(
          "--group-pages", options->group_pages,
          "Of a series: how many neighbouring pages lie together in the file step by step, a power of "
          "two up to 512. With one, all steps of a page are side by side, for playing; with many, "
          "whole steps, for looking at one alone (default 1; with --append that of the store)")
      .type_name("N");
  command.add_flag(
      "--append", options->append,
      "Add the steps behind the last one of OUTPUT, if it is there. Where the input says the time of each, "
      "as a .pvd or HDF5 may, these are the later ones; otherwise all, as of a NIfTI, which says only how "
      "far "
      "apart they are");
  command.add_option("-o,--output", options->output, "The store (.adm)").required().type_name("FILE");
}

}  // namespace adamas::cli
