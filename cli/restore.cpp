#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

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
  const char* type = sample_name(restored.written);
  session.console.print("{} x {} x {} samples, {}{}, {}\n", nx, ny, nz, type,
                        restored.steps.size() > 1 ? ", " + counted(restored.steps.size(), "step") : "",
                        bytes_text(static_cast<double>(restored.bytes)));
  Figures figures{{"samples", restored.grid.samples()},
                  {"steps", restored.steps.size()},
                  {"dimensions", restored.grid.dimensions},
                  {"type", type},
                  {"level", restored.level}};
  if (is_zarr(options.output)) figures["levels"] = restored.levels;
  add_page_counts(restored.reads, figures);
  figures["damaged_steps"] = restored.damaged_steps;
  figures["seconds"] = session.console.seconds();
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
}

void run(const Options& options, Session& session) {
  RestoreRequest request = options.request;
  request.store = options.input.path;
  request.open = options.input.open;
  request.step = options.input.step;
  request.output = options.output;
  if (!options.steps.empty()) {
    const std::uint32_t count = VolumeStore::open(options.input.path).steps();
    request.steps = wanted_steps(options.steps, options.input, count);
  }
  const RestoreReport restored = restore_files(request, session.outputs, session.console);
  report(options, restored, session);
  session.console.flush();
  if (restored.folder) restored.folder->commit();
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
  command
      .add_converted(
          "--level", "Every 2^N-th sample along each axis",
          [options](const std::string& option, const std::string& text) {
            options->request.part.level =
                static_cast<int>(std::min<std::size_t>(parse_count(option, text, 0), 99));
          },
          "0")
      .type_name("N")
      .show_default();
  command
      .add_converted("--region", "Only the samples in a box",
                     [options](const std::string& option, const std::string& text) {
                       options->request.part.region = to_box(parse_bounds(option, text));
                     })
      .type_name("x0,x1,y0,y1,z0,z1");
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
      "--overwrite", options->request.overwrite,
      "Of .zarr: replace the folder if it is there; of .pvd: replace the files of steps that are there");
}

}  // namespace adamas::cli
