#include <CLI/App.hpp>

#include "cli/command.h"
#include "cli/config_file.h"
#include "cli/help_formatter.h"
#include "cli/option_checks.h"
#include "cli/version.h"

namespace adamas {

void add_all_commands(CLI::App& app, Session& session) {
  app.set_help_flag("--help,-h", "Print this and stop");
  app.set_version_flag("--version", std::string("adamas ") + kVersion, "Print the version and stop");
  app.formatter(std::make_shared<HelpFormatter>());
  // Each command has an option of this name that hands its file on to here.
  app.set_config("--config")->group("");
  app.config_formatter(std::make_shared<ConfigFile>(app));
  app.require_subcommand(1);
  app.footer(kFirstSteps);
  add_generate(app, session);
  add_info(app, session);
  add_reconstruct(app, session);
  add_resample(app, session);
  add_select(app, session);
  add_compare(app, session);
  add_slice(app, session);
  add_probe(app, session);
  add_experiment(app, session);
  add_store(app, session);
  add_restore(app, session);
  add_verify(app, session);
  add_isosurface(app, session);
  add_completion(app, session);
  add_man(app, session);
  add_common_checks(app);
}

}  // namespace adamas
