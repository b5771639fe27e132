#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "adamas/generated_files.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/volume_options.h"

namespace adamas::cli {

namespace {

struct Options {
  std::array<std::size_t, 3> dimensions{};
  std::string type = "uint8", output;
};

void run(const Options& options, Session& session) {
  const auto& n = options.dimensions;
  const WrittenVolume written = write_buckyball({n[0], n[1], n[2]}, parse_sample_type(options.type),
                                                options.output, session.outputs, session.console);
  const Vec3& spacing = written.grid.spacing;
  Figures figures{{"dimensions", n}, {"bytes", written.bytes}, {"type", options.type}};
  figures["spacing"] = {spacing.x, spacing.y, spacing.z};
  figures["seconds"] = session.console.seconds();
  session.console.print("Buckyball of {} x {} x {} samples, {}, {}\n", n[0], n[1], n[2], options.type,
                        bytes_text(static_cast<double>(written.bytes)));
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
  command
      .add_converted("--dimensions", "Numbers of samples, or one for all axes",
                     [options = options.get()](const std::string& option, const std::string& text) {
                       options->dimensions = parse_dimensions(option, text);
                     })
      .required()
      .type_name("X,Y,Z");
  add_sample_type(command, options->type, "Of the samples, whose values fill its range; float32: 0 to 1")
      .show_default();
  add_volume_output(command, options->output);
}

}  // namespace adamas::cli
