#include "cli/command.h"

#include <memory>

#include "cli/option_values.h"
#include "cli/usage_error.h"
#include "core/base/parallel.h"

namespace adamas {

namespace {

/// More threads than this is a slip of the hand.
constexpr std::size_t kMostThreads = 4096;

/// The options of the root that a subcommand's `--config FILE` is handed to.
CLI::App& root_of(CLI::App& app) { return app.get_parent() == nullptr ? app : root_of(*app.get_parent()); }

void add_common_options(CLI::App& command, Session& session) {
  command.add_option("--json", session.json, "Write the figures of the run: .json")
      ->type_name("FILE")
      ->group("Common");
  command.add_option("--threads", session.threads, "Number of threads (default: all cores)")
      ->type_name("N")
      ->group("Common");
  command
      .add_flag("--quiet,-q", session.console.quiet,
                "Print nothing but errors and what is missing of a damaged input")
      ->group("Common");
  command.add_flag("--verbose,-v", session.console.verbose, "Print a line per stage of the work")
      ->group("Common");
  CLI::Option* config = root_of(command).get_config_ptr();
  command
      .add_option_function<std::string>(
          "--config,-c",
          [config, &session](const std::string& file) {
            config->add_result(file);
            session.config = file;
          },
          "Read options from a file of lines NAME = VALUE; those given here win")
      ->trigger_on_parse()
      ->configurable(false)
      ->type_name("FILE")
      ->group("Common");
  command.set_help_flag("--help,-h", "Print this and stop")->group("Common");
}

}  // namespace

void Session::begin() {
  if (console.quiet && console.verbose)
    wrong_usage("--quiet and --verbose: expected one of them, found both");
  std::size_t count = 0;
  if (!threads.empty()) count = parse_count("--threads", threads);
  if (count > kMostThreads) wrong_usage("--threads: expected at most {}, found {}", kMostThreads, threads);
  set_thread_limit(static_cast<unsigned>(count));
  outputs.protect_other(config);
  outputs.declare("--json", json, {".json"});
}

CLI::App* add_command(CLI::App& app, Session& session, const std::string& name,
                      const std::string& description, const std::string& example, std::function<void()> run) {
  CLI::App* command = app.add_subcommand(name, description);
  command->footer("Example:\n  " + example);
  add_common_options(*command, session);
  command->final_callback([&session, run = std::move(run)] { session.run = run; });
  return command;
}

}  // namespace adamas
