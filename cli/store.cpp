#include <cmath>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/data_summary.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/usage_error.h"
#include "cli/volume_options.h"
#include "isosurface/storage/store_builder.h"

namespace adamas {

namespace {

struct Options {
  VolumeInput input;
  std::string coding = "interpolation", smoothing, output;
  bool gradients = false;
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

double ratio(std::uint64_t before, std::uint64_t after) {
  return after > 0 ? static_cast<double>(before) / static_cast<double>(after) : 0;
}

void report(const VolumeReader& reader, const StoreFigures& store, Session& session) {
  Console& console = session.console;
  const VolumeGrid& grid = reader.grid();
  const auto [nx, ny, nz] = grid.dimensions;
  const std::uint64_t input = reader.source().sample_file_bytes();
  const double seconds = console.seconds();
  console.print("{} x {} x {} samples, {}\n", nx, ny, nz, sample_name(grid.type));
  print_store_bytes(input, store.bytes, store.file_bytes, console);
  console.print("{} pages in {:.1f} s, {:.1f} M samples/s\n", store.pages, seconds,
                static_cast<double>(grid.samples()) / seconds / 1e6);
  if (const std::string note = reader.note(); !note.empty()) console.note("{}", note);
  Figures figures{{"samples", grid.samples()},
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

void run(const Options& options, Session& session) {
  session.outputs.declare("-o", options.output, {".adm"});
  VolumeReader reader = open_volume_input(options.input, session, true);
  check_volume_dimensions(options.input.path, reader.grid());
  PlaneReader planes(reader);
  StoreOptions store;
  store.coding = options.coding == "split-edge" ? SampleCoding::kSplitEdge : SampleCoding::kInterpolation;
  if (!options.smoothing.empty() && !options.gradients)
    wrong_usage("--smoothing: expected with --gradients, which are what is smoothed");
  store.gradients = options.gradients;
  if (options.smoothing == "none") store.smoothing.reset();
  if (options.smoothing == "first") store.smoothing->constrained_rounds = 0;
  if (!options.input.scratch.empty()) store.scratch = options.input.scratch;
  StoreFigures figures;
  session.outputs.write(options.output, [&](const auto& path) {
    figures = build_store(
        path, options.output, reader.grid(),
        [&planes](std::uint64_t k, std::span<std::byte> samples) { planes.read(k, samples); }, store,
        session.console);
  });
  report(reader, figures, session);
  if (planes.infinite() > 0)
    session.console.note(
        "{}: {} not finite: surfaces have holes there", options.input.path,
        planes.infinite() == 1 ? "1 sample is" : fmt::format("{} samples are", planes.infinite()));
  session.outputs.commit();
}

}  // namespace

void add_store(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(app, session, "store", "Preprocesses and compresses a volume, without loss, into one file",
                  "adamas store head.raw --dimensions 512,512,300 --type uint16 -o head.adm",
                  [options, &session] { run(*options, session); });
  add_volume_input(command, options->input);
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
  command.add_option("-o,--output", options->output, "The store (.adm)").required().type_name("FILE");
}

}  // namespace adamas
