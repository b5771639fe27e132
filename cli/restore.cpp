#include <algorithm>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "adamas/series.h"
#include "adamas/volume_output.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/ome_zarr.h"
#include "cli/option_values.h"
#include "cli/restored_steps.h"
#include "cli/store_options.h"
#include "cli/usage.h"
#include "cli/volume_options.h"
#include "core/data/volume_placement.h"
#include "core/io/input_file.h"
#include "core/io/zarr_array.h"

namespace adamas::cli {

using namespace io;
using namespace isosurface;
using namespace timevarying;

namespace {

struct Options {
  StoreInput input;
  std::string level = "0", region, steps, output;
  bool overwrite = false;
};

/// What is restored of each step.
struct Wanted {
  std::vector<RestoredPart> levels;  ///< one, but for the pyramid of a .zarr
  std::size_t memory = 0;
};

/// What was written.
struct Written {
  std::size_t bytes = 0;
  RestoredSteps steps;
  PageCounts counts;
};

/// One step where one is named, those of --steps otherwise.
StepRange restored_steps(const Options& options, const StoreFile& file, Session& session) {
  if (options.input.step.empty()) return wanted_steps(options.steps, options.input, file);
  if (!options.steps.empty()) wrong_usage("--step and --steps: expected one of them");
  const std::uint32_t step = wanted_step(options.input, file, session);
  return {step, step};
}

std::size_t write_step(const Options& options, StoreFile& file, const Wanted& wanted, PageCounts& counts,
                       Session& session) {
  const std::uint32_t step = wanted_step(options.input, file, session);
  return write_volume_output(
      options.output, wanted.levels.front().grid, "samples",
      [&](const PlaneSink& sink) {
        counts = restore_step(file, step, wanted.levels.front(), wanted.memory, sink, session.console);
      },
      session.outputs);
}

/// F.pvd and F_0000.vti, F_0001.vti, ... beside it.
class PvdSeries {
 public:
  PvdSeries(const Options& options, StoreFile& file, const Wanted& wanted, Session& session)
      : list_(options.output), file_(file), wanted_(wanted), session_(session) {
    all_ = restored_steps(options, file, session);
    const std::vector<double> times = file.times();
    for (std::uint32_t step = all_.first; step <= all_.last; ++step) {
      entries_.push_back({times[step], step_file(list_, step, ".vti")});
      if (!options.overwrite) refuse_existing(path(step));
      session.outputs.declare("-o", path(step), {".vti"});
    }
  }

  void write(Written& written) {
    const RestoredPart& part = wanted_.levels.front();
    const auto write_all = [&](const StepNumbers& steps) {
      bytes_ = 0;
      written.counts = {};
      for (const StepRange& some : restored_groups(steps, restored_slab_bytes(part), wanted_.memory))
        write_group(some, written.counts);
    };
    written.steps = restore_what_can_be(file_, all_, part, wanted_.memory, write_all, session_);
    std::vector<SeriesEntry> entries;
    for (const std::uint32_t step : written.steps.kept) entries.push_back(entries_[step - all_.first]);
    for (const std::uint32_t step : written.steps.lost) session_.outputs.leave_out(path(step));
    const std::string list = list_.string();
    session_.outputs.write(list, [&entries](const auto& name) { write_series(name, entries); });
    written.bytes = bytes_ + session_.outputs.bytes(list);
  }

 private:
  /// Nobody has named the files of steps, which may be of another series, or what the store was made of.
  void refuse_existing(const std::string& file) const {
    std::error_code unknown;
    if (std::filesystem::exists(file, unknown))
      fail("{}: expected no file of a step there yet, found {}: --overwrite replaces such files",
           list_.string(), file);
  }
  [[nodiscard]] std::string path(std::uint32_t step) const {
    return (list_.parent_path() / entries_[step - all_.first].file).string();
  }

  /// What is damaged is told by a DamagedPage, although outputs make other errors of those that pass them.
  void write_group(const StepRange& some, PageCounts& counts) {
    sinks_.clear();
    damage_.reset();
    try {
      write(some, counts);
    } catch (const Error&) {
      if (damage_) throw *damage_;
      throw;
    }
  }

  /// Opens the files of some steps one within another, and writes to all of them when the last is open.
  void write(const StepRange& some, PageCounts& counts) {
    const auto step = some.first + static_cast<std::uint32_t>(sinks_.size());
    const RestoredPart& part = wanted_.levels.front();
    if (step > some.last) {
      const auto sink = [this, &some](std::uint32_t n, std::span<const std::byte> plane) {
        sinks_[n - some.first](plane);
      };
      try {
        counts += restore_steps(file_, some, part, wanted_.memory, sink, session_.console);
      } catch (const DamagedPage& damage) {
        damage_ = damage;
        throw;
      }
      return;
    }
    const auto make = [&](const PlaneSink& sink) {
      sinks_.push_back(sink);
      write(some, counts);
    };
    bytes_ += write_volume_output(path(step), part.grid, "samples", make, session_.outputs);
  }

  std::filesystem::path list_;
  StoreFile& file_;
  const Wanted& wanted_;
  Session& session_;
  StepRange all_;
  std::vector<SeriesEntry> entries_;
  std::vector<PlaneSink> sinks_;  ///< of the files that are open
  std::optional<DamagedPage> damage_;
  std::size_t bytes_ = 0;
};

/// What the options ask for.
Wanted find_wanted(const Options& options, const StoreFile& file, Session& session) {
  const VolumeGrid& volume = file.header().grid;
  std::optional<Box3> region;
  if (!options.region.empty()) {
    const FrameRegion found = region_in_frame(volume, to_box(parse_bounds("--region", options.region)));
    region = found.box;
    if (!found.sides.empty())
      session.console.note("{}: its axes run aslant: the samples round the region, in a box along them",
                           options.input.path);
  }
  const int level = static_cast<int>(std::min<std::size_t>(parse_count("--level", options.level, 0), 99));
  // A coarser level would not be faster to look at than one of a single chunk.
  const std::uint64_t enough =
      is_zarr(options.output) ? ZarrArray::kSide : std::numeric_limits<std::uint64_t>::max();
  return {restored_levels(volume, level, region, enough, options.input.path), store_memory(options.input)};
}

ZarrContent zarr_content(const Options& options, const StoreFile& file, const Wanted& wanted,
                         Session& session) {
  const bool is_series = options.input.step.empty() && file.steps() > 1;
  return {wanted.levels, restored_steps(options, file, session), is_series, wanted.memory};
}

void report(const Options& options, const Wanted& wanted, const Written& written, Session& session) {
  const RestoredPart& part = wanted.levels.front();
  const auto [nx, ny, nz] = part.grid.dimensions;
  const char* type = sample_name(written_type(options.output, part.grid));
  session.console.print(
      "{} x {} x {} samples, {}{}, {}\n", nx, ny, nz, type,
      written.steps.kept.size() > 1 ? ", " + counted(written.steps.kept.size(), "step") : "",
      bytes_text(static_cast<double>(written.bytes)));
  Figures figures{{"samples", part.grid.samples()},
                  {"steps", written.steps.kept.size()},
                  {"dimensions", part.grid.dimensions},
                  {"type", type},
                  {"level", part.lod}};
  if (is_zarr(options.output)) figures["levels"] = wanted.levels.size();
  add_page_counts(written.counts, figures);
  figures["damaged_steps"] = written.steps.lost;
  figures["seconds"] = session.console.seconds();
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
}

/// Throws Error (kUsage) where options do not go together.
void check_options(const Options& options) {
  const bool is_folder_or_list = is_zarr(options.output) || file_extension(options.output) == ".pvd";
  if (options.overwrite && !is_folder_or_list)
    wrong_usage("--overwrite: expected a series or a folder, -o F.pvd or F.zarr, found '-o {}'",
                options.output);
  if (!options.steps.empty() && !is_folder_or_list)
    wrong_usage("--steps: expected a series as well, -o F.pvd or F.zarr, found '-o {}'", options.output);
}

void run(const Options& options, Session& session) {
  check_options(options);
  const bool is_series = file_extension(options.output) == ".pvd";
  std::optional<OmeZarr> zarr;
  if (is_zarr(options.output)) {
    session.outputs.protect(options.input.path);
    session.outputs.check_outside("-o", options.output);
    zarr.emplace(options.output, options.overwrite);
  } else if (is_series) {
    session.outputs.declare("-o", options.output, {".pvd"});
  } else {
    declare_volume_output(options.output, session.outputs);
  }
  const std::unique_ptr<StoreFile> file = open_store(options.input, session);
  const Wanted wanted = find_wanted(options, *file, session);
  Written written;
  if (zarr) {
    const ZarrContent content = zarr_content(options, *file, wanted, session);
    written.steps = zarr->write(*file, content, written.counts, session);
    written.bytes = zarr->bytes();
  } else {
    note_lost(options.output, wanted.levels.front().grid, session.console);
    if (is_series) {
      PvdSeries(options, *file, wanted, session).write(written);
    } else {
      written.bytes = write_step(options, *file, wanted, written.counts, session);
      written.steps.kept = {0};
    }
  }
  // Each part of the work has counted those of the whole file.
  written.counts.bytes = file->bytes_read();
  report(options, wanted, written, session);
  session.console.flush();
  if (zarr) zarr->commit();
  session.commit();
}

}  // namespace

void add_restore(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command = add_command(
      app, session, "restore",
      "The samples of a store back as a volume, bit for bit; with a scale, their values (float32)",
      "adamas restore head.adm --level 2 -o small.vti", [options, &session] { run(*options, session); });
  add_store_input(command, options->input);
  command.add_option("--level", options->level, "Every 2^N-th sample along each axis")
      .type_name("N")
      .show_default();
  command.add_option("--region", options->region, "Only the samples in a box").type_name("x0,x1,y0,y1,z0,z1");
  add_step_option(command, options->input);
  command
      .add_option("--steps", options->steps,
                  "Of a series written as .pvd or .zarr: only the steps from A to B")
      .type_name("A,B");
  command
      .add_option(
          "-o,--output", options->output,
          "The volume: .vti, .nrrd, .mha, .nii, .nii.gz, .nhdr or .mhd with a .raw beside it, or .raw "
          "alone; of a series also .pvd, with a .vti of each step beside it. Or .zarr, a folder: volumes and "
          "series with their coarser levels, as OME-Zarr 0.4")
      .required()
      .type_name("FILE");
  command.add_flag(
      "--overwrite", options->overwrite,
      "Of .zarr: replace the folder if it is there; of .pvd: replace the files of steps that are there");
}

}  // namespace adamas::cli
