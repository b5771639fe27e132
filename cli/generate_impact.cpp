#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/figures.h"
#include "cli/generate_commands.h"
#include "cli/option_values.h"
#include "core/io/multi_material_writer.h"
#include "datasets/flow/impact.h"

namespace adamas {

namespace {

struct Options {
  std::string dimensions, box, steps, end_time, speed, output;
};

void run(const Options& options, Session& session) {
  ImpactOptions impact;
  double end = 6;
  if (!options.dimensions.empty()) impact.cells = parse_dimensions("--dimensions", options.dimensions);
  if (!options.box.empty()) impact.box = to_box(parse_bounds("--box", options.box));
  if (!options.speed.empty()) impact.speed = parse_positive("--speed", options.speed);
  if (!options.end_time.empty()) end = parse_positive("--end-time", options.end_time);
  session.outputs.declare("-o", options.output, {".vtr", ".vti"});
  FlowSolver<3> flow = make_impact(impact);
  flow.advance_to(end, session.console);
  const MultiMaterialData data = flow_data(flow, "impact", kImpactUnits);
  session.outputs.write(options.output, [&data](const auto& path) { write_multi_material_data(path, data); });
  session.outputs.commit();
}

}  // namespace

void add_generate_impact(CLI::App& generate, Session& session) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = add_command(
      generate, session, "impact", "A projectile that strikes a block: compressible flow of three materials",
      "adamas generate impact -o impact.pvd --steps 10", [options, &session] { run(*options, session); });
  command->add_option("--dimensions", options->dimensions, "Numbers of cells (default 32,32,52)")
      ->type_name("X,Y,Z");
  command->add_option("--box", options->box, "The domain in cm (default 0,12,0,12,-16,4.8)")
      ->type_name("x0,x1,y0,y1,z0,z1");
  command->add_option("--end-time", options->end_time, "Time of the last step in microseconds")
      ->type_name("T");
  command->add_option("--speed", options->speed, "Speed of the projectile in cm per microsecond")
      ->type_name("V");
  command->add_option("-o,--output", options->output, "The data: .vtr or .vti")
      ->required()
      ->type_name("FILE");
}

}  // namespace adamas
