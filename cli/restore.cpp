#include "isosurface/storage/restore.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/store_options.h"
#include "cli/usage_error.h"
#include "cli/volume_options.h"
#include "core/data/volume_placement.h"
#include "core/io/input_file.h"
#include "core/io/series_file.h"

namespace adamas {

namespace {

struct Options {
  StoreInput input;
  std::string level = "0", region, steps, output;
};

/// What is restored of each step.
struct Wanted {
  RestoredPart part;
  std::size_t memory = 0;
};

/// The steps of --steps A,B, both included; all where nothing is given.
std::pair<std::uint32_t, std::uint32_t> wanted_steps(const Options& options, const StoreFile& file,
                                                     Session& session) {
  if (!options.input.step.empty()) {
    if (!options.steps.empty()) wrong_usage("--step and --steps: expected one of them");
    const std::uint32_t step = wanted_step(options.input, file, session);
    return {step, step};
  }
  if (options.steps.empty()) return {0, file.steps() - 1};
  const std::size_t comma = options.steps.find(',');
  if (comma == std::string::npos) wrong_usage("--steps: expected A,B, found '{}'", options.steps);
  const std::size_t first = parse_count("--steps", options.steps.substr(0, comma), 0);
  const std::size_t last = parse_count("--steps", options.steps.substr(comma + 1), 0);
  if (first > last || last >= file.steps())
    wrong_usage("--steps: expected steps from 0 to {} in ascending order, found '{}'", file.steps() - 1,
                options.steps);
  return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)};
}

std::size_t write_step(const std::string& output, StoreFile& file, std::uint32_t step, const Wanted& wanted,
                       PageCounts& counts, Session& session) {
  return write_volume_output(
      output, wanted.part.grid, "samples",
      [&](const PlaneSink& sink) {
        counts += restore(file, step, wanted.part, wanted.memory, sink, session.console);
      },
      session);
}

/// Writes F.pvd and F_0000.vti, F_0001.vti, ... beside it.
std::size_t write_steps(const Options& options, StoreFile& file, const Wanted& wanted, PageCounts& counts,
                        Session& session) {
  const auto [first, last] = wanted_steps(options, file, session);
  const std::filesystem::path list = options.output;
  const std::vector<double> times = file.times();
  std::vector<SeriesEntry> entries;
  for (std::uint32_t step = first; step <= last; ++step) {
    const std::string name = step_file(list, step, ".vti");
    entries.push_back({times[step], name});
    session.outputs.declare("-o", (list.parent_path() / name).string(), {".vti"});
  }
  std::size_t bytes = 0;
  for (std::uint32_t step = first; step <= last; ++step)
    bytes += write_step((list.parent_path() / entries[step - first].file).string(), file, step, wanted,
                        counts, session);
  session.outputs.write(options.output, [&](const auto& path) { write_series(path, entries); });
  return bytes + session.outputs.bytes(options.output);
}

void run(const Options& options, Session& session) {
  const bool is_series = file_extension(options.output) == ".pvd";
  if (is_series) {
    session.outputs.declare("-o", options.output, {".pvd"});
  } else {
    declare_volume_output(options.output, session.outputs);
  }
  const std::size_t memory = store_memory(options.input);
  const std::unique_ptr<StoreFile> file = open_store(options.input, session);
  std::optional<Box3> region;
  if (!options.region.empty()) {
    const FrameRegion found =
        region_in_frame(file->header().grid, to_box(parse_bounds("--region", options.region)));
    region = found.box;
    if (!found.sides.empty())
      session.console.note("{}: its axes run aslant: the samples round the region, in a box along them",
                           options.input.path);
  }
  const int level = static_cast<int>(std::min<std::size_t>(parse_count("--level", options.level, 0), 99));
  const Wanted wanted{restored_part(file->header().grid, level, region, options.input.path), memory};
  const RestoredPart& part = wanted.part;
  PageCounts counts;
  if (!is_series && !options.steps.empty())
    wrong_usage("--steps: expected a series as well, -o F.pvd, found '-o {}'", options.output);
  const std::size_t bytes =
      is_series ? write_steps(options, *file, wanted, counts, session)
                : write_step(options.output, *file, wanted_step(options.input, *file, session), wanted,
                             counts, session);
  const auto [nx, ny, nz] = part.grid.dimensions;
  session.console.print("{} x {} x {} samples, {}, {}\n", nx, ny, nz, sample_name(part.grid.type),
                        bytes_text(static_cast<double>(bytes)));
  Figures figures{{"samples", part.grid.samples()},
                  {"dimensions", part.grid.dimensions},
                  {"type", sample_name(part.grid.type)},
                  {"level", level}};
  add_page_counts(counts, figures);
  figures["seconds"] = session.console.seconds();
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
  session.outputs.commit();
}

}  // namespace

void add_restore(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command = add_command(
      app, session, "restore", "The samples of a store back as a volume, bit for bit",
      "adamas restore head.adm --level 2 -o small.vti", [options, &session] { run(*options, session); });
  add_store_input(command, options->input);
  command.add_option("--level", options->level, "Every 2^N-th sample along each axis")
      .type_name("N")
      .show_default();
  command.add_option("--region", options->region, "Only the samples in a box").type_name("x0,x1,y0,y1,z0,z1");
  add_step_option(command, options->input);
  command.add_option("--steps", options->steps, "Of a series written as .pvd: only the steps from A to B")
      .type_name("A,B");
  command
      .add_option(
          "-o,--output", options->output,
          "The volume: .vti, .nrrd, .mha, .nii, .nii.gz, .nhdr or .mhd with a .raw beside it, or .raw "
          "alone; of a series also .pvd, with a .vti of each step beside it")
      .required()
      .type_name("FILE");
}

}  // namespace adamas
