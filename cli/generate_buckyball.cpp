#include <array>

#include "adamas/generated_files.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/volume_options.h"

namespace adamas::cli {

namespace {

struct Options {
  std::array<std::size_t, 3> dimensions{};
  SampleType type = SampleType::kUint8;
  std::string output;
};

void run(const Options& options, Session& session) {
  const auto& n = options.dimensions;
  const WrittenVolume written =
      write_buckyball({n[0], n[1], n[2]}, options.type, options.output, session.outputs, session.console);
  Figures figures{{"dimensions", n}, {"bytes", written.bytes}, {"type", sample_name(options.type)}};
  figures["spacing"] = place_figures(written.grid.spacing);
  add_costs(figures, session.console);
  session.console.print("Buckyball of {} x {} x {} samples, {}, {}\n", n[0], n[1], n[2],
                        sample_name(options.type), bytes_text(static_cast<double>(written.bytes)));
  write_figures(figures, session);
  session.commit();
}

}  // namespace

void add_generate_buckyball(const Command& generate, Session& session) {
  const auto [command, options] =
      add_command(generate, session, "buckyball", "A volume of Gaussians at the 60 atoms of a buckyball",
                  "adamas generate buckyball --dimensions 256 -o ball.nhdr", run);
  command
      .add_value("--dimensions", "X,Y,Z", "Numbers of samples, or one for all axes", options.dimensions,
                 parse_dimensions)
      .required();
  command.add_choice("--type", "Of the samples, whose values fill its range; float32: 0 to 1", options.type,
                     made_types(), "uint8");
  add_volume_output(command, options.output);
}

}  // namespace adamas::cli
