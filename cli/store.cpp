#include <cmath>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/command.h"
#include "cli/data_summary.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/usage_error.h"
#include "cli/volume_options.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/series_file.h"
#include "isosurface/storage/store_builder.h"
#include "isosurface/storage/store_file.h"

namespace adamas {

namespace {

struct Options {
  std::vector<std::string> inputs;
  VolumeInput input;
  std::string coding = "interpolation", block_steps = "32", smoothing, output;
  bool gradients = false, append = false;
};

/// Reads planes for the builder, which asks for some of them twice, and counts the samples that are no finite
/// numbers.
class PlaneReader {
 public:
  explicit PlaneReader(VolumeReader& reader) : reader_(reader), counted_(reader.grid().dimensions[2]) {}

  void read(std::uint64_t k, std::span<std::byte> samples) {
    reader_.read_plane(k, samples);
    if (reader_.grid().type != SampleType::kFloat32 || counted_[k]) return;
    counted_[k] = true;
    for (std::size_t at = 0; at < samples.size(); at += sizeof(float)) {
      float value = 0;
      std::memcpy(&value, samples.data() + at, sizeof(value));
      infinite_ += std::isfinite(value) ? 0 : 1;
    }
  }
  [[nodiscard]] std::uint64_t infinite() const { return infinite_; }

 private:
  VolumeReader& reader_;
  std::vector<bool> counted_;
  std::uint64_t infinite_ = 0;
};

/// Says in what a step's grid is another than that of others.
[[noreturn]] void refuse_grid(const std::string& path, const VolumeGrid& found, const std::string& first,
                              const VolumeGrid& wanted) {
  const auto text = [](const VolumeGrid& grid) {
    return fmt::format("{} x {} x {} {}", grid.dimensions[0], grid.dimensions[1], grid.dimensions[2],
                       sample_name(grid.type));
  };
  if (text(found) != text(wanted))
    fail("{}: expected {} samples as {} has, found {}", path, text(wanted), first, text(found));
  fail("{}: expected the place, spacing and scale of the samples of {}, found others", path, first);
}

/// A step that is being read.
struct OpenStep {
  explicit OpenStep(VolumeReader from) : reader(std::move(from)) {}

  VolumeReader reader;
  PlaneReader planes{reader};
};

/// Steps of a series, opened one after another as they are asked for. All have the grid of the first.
class Steps {
 public:
  Steps(const Options& options, std::vector<SeriesEntry> entries, Session& session)
      : options_(options), entries_(std::move(entries)), session_(session) {
    open(0);
    grid_ = step_->reader.grid();
  }

  [[nodiscard]] const VolumeGrid& grid() const { return grid_; }
  [[nodiscard]] std::vector<double> times() const {
    std::vector<double> times;
    for (const SeriesEntry& entry : entries_) times.push_back(entry.time);
    return times;
  }
  PlaneSource planes(std::uint32_t n) {
    if (n != opened_) open(n);
    return [this](std::uint64_t k, std::span<std::byte> samples) { step_->planes.read(k, samples); };
  }
  /// Takes in what there is to say of the last step.
  void close() {
    if (step_ == nullptr) return;
    input_bytes_ += step_->reader.source().sample_file_bytes();
    if (const std::string note = step_->reader.note(); !note.empty()) session_.console.note("{}", note);
    const std::uint64_t infinite = step_->planes.infinite();
    if (infinite > 0)
      session_.console.note("{}: {} not finite: surfaces have holes there", entries_[opened_].file,
                            infinite == 1 ? "1 sample is" : fmt::format("{} samples are", infinite));
    step_.reset();
  }
  [[nodiscard]] std::uint64_t input_bytes() const { return input_bytes_; }
  [[nodiscard]] std::size_t count() const { return entries_.size(); }

 private:
  void open(std::uint32_t n) {
    close();
    VolumeInput input = options_.input;
    input.path = entries_[n].file;
    step_ = std::make_unique<OpenStep>(open_volume_input(input, session_, true));
    opened_ = n;
    const VolumeGrid& grid = step_->reader.grid();
    check_volume_dimensions(input.path, grid);
    if (n > 0 && grid != grid_) refuse_grid(input.path, grid, entries_.front().file, grid_);
  }

  const Options& options_;
  std::vector<SeriesEntry> entries_;
  Session& session_;
  VolumeGrid grid_;
  std::unique_ptr<OpenStep> step_;
  std::uint32_t opened_ = 0;
  std::uint64_t input_bytes_ = 0;
};

double ratio(std::uint64_t before, std::uint64_t after) {
  return after > 0 ? static_cast<double>(before) / static_cast<double>(after) : 0;
}

void report(const Steps& steps, const StoreFigures& store, Session& session) {
  Console& console = session.console;
  const VolumeGrid& grid = steps.grid();
  const auto [nx, ny, nz] = grid.dimensions;
  const std::uint64_t input = steps.input_bytes();
  const double seconds = console.seconds();
  console.print("{} x {} x {} samples, {}{}\n", nx, ny, nz, sample_name(grid.type),
                steps.count() > 1 ? fmt::format(", {} steps", steps.count()) : "");
  print_store_bytes(input, store.bytes, store.file_bytes, console);
  console.print("{} pages in {:.1f} s, {:.1f} M samples/s\n", store.pages, seconds,
                static_cast<double>(grid.samples() * steps.count()) / seconds / 1e6);
  Figures figures{{"samples", grid.samples()},
                  {"steps", steps.count()},
                  {"dimensions", grid.dimensions},
                  {"type", sample_name(grid.type)},
                  {"bytes_input", input},
                  {"bytes_data", store.bytes.samples},
                  {"bytes_gradients", store.bytes.gradients},
                  {"bytes_errors", store.bytes.bounds},
                  {"bytes_file", store.file_bytes},
                  {"ratio_data", ratio(input, store.bytes.samples)},
                  {"ratio", ratio(input, store.file_bytes)},
                  {"pages", store.pages},
                  {"seconds", seconds},
                  {"peak_memory_bytes", peak_memory_bytes()}};
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
}

StoreOptions store_options(const Options& options) {
  StoreOptions store;
  store.coding = options.coding == "split-edge" ? SampleCoding::kSplitEdge : SampleCoding::kInterpolation;
  if (!options.smoothing.empty() && !options.gradients)
    wrong_usage("--smoothing: expected with --gradients, which are what is smoothed");
  store.gradients = options.gradients;
  if (options.smoothing == "none") store.smoothing.reset();
  if (options.smoothing == "first") store.smoothing->constrained_rounds = 0;
  if (!options.input.scratch.empty()) store.scratch = options.input.scratch;
  const std::size_t block_steps = parse_count("--block-steps", options.block_steps, 1);
  if (block_steps > kMostBlockSteps)
    wrong_usage("--block-steps: expected from 1 to {}, found {}", kMostBlockSteps, options.block_steps);
  store.block_steps = static_cast<std::uint32_t>(block_steps);
  return store;
}

/// The steps that are to be added to a store: of those that have times the later ones, others at the times
/// behind its last one.
std::vector<SeriesEntry> later_steps(std::vector<SeriesEntry> entries, bool have_times, double last) {
  if (have_times) {
    std::erase_if(entries, [last](const SeriesEntry& entry) { return entry.time <= last; });
    return entries;
  }
  for (SeriesEntry& entry : entries) entry.time += std::floor(last) + 1;
  return entries;
}

void append(const Options& options, std::vector<SeriesEntry> entries, Session& session) {
  const StoreOptions store = store_options(options);
  const bool have_times = file_extension(options.inputs[0]) == ".pvd";
  VolumeGrid grid;
  {
    const StoreFile file(options.output);
    grid = file.header().grid;
    const std::size_t given = entries.size();
    entries = later_steps(std::move(entries), have_times, file.times().back());
    if (entries.size() < given)
      session.console.note("{}: {} of {} steps are not later than the last one of {}", options.inputs[0],
                           given - entries.size(), given, options.output);
  }
  if (entries.empty()) return;
  const std::string first = entries.front().file;
  Steps steps(options, std::move(entries), session);
  if (steps.grid() != grid) refuse_grid(first, steps.grid(), options.output, grid);
  const SeriesSource series{grid, steps.times(), [&steps](std::uint32_t step) { return steps.planes(step); }};
  const StoreFigures figures = append_series(options.output, series, store, session.console);
  steps.close();
  report(steps, figures, session);
}

void run(const Options& options, Session& session) {
  std::vector<SeriesEntry> entries;
  if (!options.input.stack) entries = find_series(options.inputs);
  if (options.input.stack && options.inputs.size() > 1)
    wrong_usage("--stack: expected one pattern, found {} inputs", options.inputs.size());
  if (entries.empty()) entries = {{0, options.inputs[0]}};
  std::error_code unknown;
  if (options.append && std::filesystem::exists(options.output, unknown)) {
    // The store is input and output: it stays whole, whatever becomes of what is added.
    append(options, std::move(entries), session);
    session.outputs.commit();
    return;
  }
  session.outputs.declare("-o", options.output, {".adm"});
  const StoreOptions store = store_options(options);
  Steps steps(options, std::move(entries), session);
  const SeriesSource series{steps.grid(), steps.times(),
                            [&steps](std::uint32_t step) { return steps.planes(step); }};
  StoreFigures figures;
  session.outputs.write(options.output, [&](const auto& path) {
    figures = build_series(path, options.output, series, store, session.console);
  });
  steps.close();
  report(steps, figures, session);
  session.outputs.commit();
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
              "volumes, a pattern of their names in quotes, as \"run_%04d.vti\", or a .pvd")
      .required()
      .type_name("FILE...");
  add_volume_options(command, options->input, "--origin,--first-sample");
  command
      .add_option("--coding", options->coding,
                  "How samples are predicted: from all neighbours that are known, or only from the two ends "
                  "of the edge whose middle they are")
      .one_of({"interpolation", "split-edge"})
      .show_default();
  command.add_flag(
      "--gradients", options->gradients,
      "Keep the directions of the samples' gradients too, smoothed, for the normals of surfaces");
  command
      .add_option(
          "--smoothing", options->smoothing,
          "How gradients are smoothed: not at all; by the first phase, which also fills regions where "
          "nothing changes; or by both (default)")
      .one_of({"none", "first", "both"});
  command
      .add_option("--block-steps", options->block_steps,
                  "Of a series: how many steps a page has side by side in the file. Playing goes fast where "
                  "they are many, looking at one step where they are few")
      .type_name("N")
      .show_default();
  command.add_flag(
      "--append", options->append,
      "Add the steps behind the last one of OUTPUT, if it is there. Of a .pvd these are the later ones");
  command.add_option("-o,--output", options->output, "The store (.adm)").required().type_name("FILE");
}

}  // namespace adamas
