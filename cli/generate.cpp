#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/generate_commands.h"

namespace adamas {

void add_generate(CLI::App& app, Session& session) {
  CLI::App* generate = app.add_subcommand("generate", "Make a data set with known truth");
  generate->require_subcommand(1);
  generate->set_help_flag("--help,-h", "Print this and stop");
  generate->footer("Example:\n  adamas generate scene voronoi10 --dimensions 32,32,32 --seed 7 -o cells.vtr");
  add_generate_scene(*generate, session);
  add_generate_impact(*generate, session);
  add_generate_buckyball(*generate, session);
}

}  // namespace adamas
