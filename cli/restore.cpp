#include "isosurface/storage/restore.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/store_options.h"
#include "cli/volume_options.h"
#include "core/data/volume_placement.h"

namespace adamas {

namespace {

struct Options {
  StoreInput input;
  std::string level = "0", region, output;
};

void run(const Options& options, Session& session) {
  declare_volume_output(options.output, session.outputs);
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
  const RestoredPart part = restored_part(file->header().grid, level, region, options.input.path);
  PageCounts counts;
  const std::size_t bytes = write_volume_output(
      options.output, part.grid, "samples",
      [&](const PlaneSink& sink) { counts = restore(*file, 0, part, memory, sink, session.console); },
      session);
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
  add_volume_output(command, options->output);
}

}  // namespace adamas
