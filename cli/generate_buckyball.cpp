#include <memory>
#include <nlohmann/json.hpp>

#include "adamas/volume_output.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/volume_options.h"
#include "datasets/buckyball.h"

namespace adamas::cli {

using namespace datasets;
using namespace io;

namespace {

struct Options {
  std::string dimensions, type = "uint8", output;
};

void run(const Options& options, Session& session) {
  const auto n = parse_dimensions("--dimensions", options.dimensions);
  declare_volume_output(options.output, session.outputs);
  const Buckyball ball({n[0], n[1], n[2]}, parse_sample_type(options.type));
  const VolumeGrid& grid = ball.grid();
  const auto make = [&](const PlaneSink& sink) {
    std::vector<std::byte> samples(grid.plane_bytes());
    const std::uint64_t planes = grid.dimensions[2];
    for (std::uint64_t k = 0; k < planes; ++k) {
      session.console.step("writing " + options.output, static_cast<double>(k) / static_cast<double>(planes));
      ball.plane(k, samples);
      sink(samples);
    }
  };
  const std::size_t bytes = write_volume_output(options.output, grid, "buckyball", make, session.outputs);
  Figures figures{{"dimensions", n}, {"bytes", bytes}, {"type", options.type}};
  figures["spacing"] = {grid.spacing.x, grid.spacing.y, grid.spacing.z};
  figures["seconds"] = session.console.seconds();
  session.console.print("Buckyball of {} x {} x {} samples, {}, {}\n", n[0], n[1], n[2], options.type,
                        bytes_text(static_cast<double>(bytes)));
  session.outputs.write(session.json, [&figures](const auto& path) { write_figures(path, figures); });
  session.commit();
}

}  // namespace

void add_generate_buckyball(const Command& generate, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(generate, session, "buckyball", "A volume of Gaussians at the 60 atoms of a buckyball",
                  "adamas generate buckyball --dimensions 256 -o ball.nhdr",
                  [options, &session] { run(*options, session); });
  command.add_option("--dimensions", options->dimensions, "Numbers of samples, or one for all axes")
      .required()
      .type_name("X,Y,Z");
  add_sample_type(command, options->type, "Of the samples, whose values fill its range; float32: 0 to 1")
      .show_default();
  add_volume_output(command, options->output);
}

}  // namespace adamas::cli
