#include <algorithm>

#include "adamas/play.h"
#include "adamas/store_files.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/store_options.h"

namespace adamas::cli {

namespace {

struct Options {
  StoreInput input;
  RestoreRequest request;
  std::string steps, output;
};

void report(const Options& options, const RestoreReport& restored, Session& session) {
  const auto [nx, ny, nz] = restored.grid.dimensions;
  const std::string type = to_string(restored.written);
  session.console.print("{} x {} x {} samples, {}{}, {}\n", nx, ny, nz, type,
                        restored.steps.size() > 1 ? ", " + counted(restored.steps.size(), "step") : "",
                        bytes_text(static_cast<double>(restored.bytes)));
  Figures figures{{"samples", restored.grid.samples()},
                  {"steps", restored.steps.size()},
                  {"dimensions", restored.grid.dimensions},
                  {"type", type},
                  {"level", restored.lod}};
  if (is_zarr(options.output)) figures["levels"] = restored.lods;
  add_page_counts(restored.reads, figures);
  figures["damaged_steps"] = restored.damaged_steps;
  add_costs(figures, session.console);
  write_figures(figures, session);
}

void run(const Options& options, Session& session) {
  RestoreRequest request = options.request;
  request.store = options.input.path;
  request.open = options.input.open;
  request.step = options.input.step;
  request.output = options.output;
  const std::string& path = options.input.path;
  if (!options.steps.empty())
    request.steps = parse_steps(
        options.steps, [&path] { return stored_steps(path); }, path);
  const RestoreReport restored = restore_files(request, session.outputs, session.console);
  report(options, restored, session);
  session.console.flush();
  if (restored.folder) restored.folder->commit();
  session.commit();
}

int parse_level(const std::string& option, const std::string& text) {
  return static_cast<int>(std::min<std::size_t>(parse_count_from_0(option, text), 99));
}

}  // namespace

void add_restore(const Command& app, Session& session) {
  const auto [command, options] = add_command(
      app, session, "restore",
      "The samples of a store back as a volume, bit for bit; with a scale, their values (float32)",
      "adamas restore head.adm --level 2 -o small.vti", run);
  RestoreRequest& request = options.request;
  add_store_input(command, options.input);
  command.add_value("--level", "N", "Every 2^N-th sample along each axis", request.part.lod, parse_level,
                    "0");
  command.add_value("--region", "x0,x1,y0,y1,z0,z1", "Only the samples in a box", request.part.region,
                    parse_box);
  add_step_option(command, options.input);
  command.add_option("--steps", "A,B", "Of a series written as .pvd or .zarr: only the steps from A to B",
                     options.steps);
  command
      .add_option(
          "-o,--output", "FILE",
          "The volume: .vti, .nrrd, .mha, .nii, .nii.gz, .nhdr or .mhd with a .raw beside it, or .raw alone; "
          "of a series also .pvd, with a .vti of each step beside it. Or .zarr, a folder: volumes and series "
          "with their coarser levels, as OME-Zarr 0.4",
          options.output)
      .required();
  command.add_flag(
      "--overwrite",
      "Of .zarr: replace the folder if it is there; of .pvd: replace the files of steps that are there",
      request.overwrite);
}

}  // namespace adamas::cli
