#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <string>

#include "cli/console.h"
#include "cli/output_set.h"

namespace adamas {

/// What all commands have in common: the options that every one takes, and what a run needs besides its own
/// options.
struct Session {
  std::string json;     ///< --json, empty where not given
  std::string threads;  ///< --threads
  std::string config;   ///< --config
  Console console;
  OutputSet outputs;
  /// Set by the chosen command; called when the command line is known to be sound.
  std::function<void()> run;

  /// The program's own start: what has to be done between parsing and running.
  void begin();
};

/// What a newcomer types first: data to try, what is in them, a mesh, a look at it, more about a command.
inline constexpr const char* kFirstSteps =
    "First steps:\n"
    "  adamas generate scene voronoi10 --dimensions 48 -o cells.vtr\n"
    "  adamas info cells.vtr\n"
    "  adamas resample cells.vtr --interface-error 1% -o mesh.vtu\n"
    "  adamas slice mesh.vtu --plane z=0.5 -o slice.png\n"
    "  adamas resample --help";

/// A subcommand with the common options. `example` is shown by --help. `run` is called for the command that
/// was chosen; it may throw UsageError, Error and Cancelled.
CLI::App* add_command(CLI::App& app, Session& session, const std::string& name,
                      const std::string& description, const std::string& example, std::function<void()> run);

// One function per command, in the file of its name.
void add_generate(CLI::App& app, Session& session);
void add_info(CLI::App& app, Session& session);
void add_reconstruct(CLI::App& app, Session& session);
void add_resample(CLI::App& app, Session& session);
void add_select(CLI::App& app, Session& session);
void add_compare(CLI::App& app, Session& session);
void add_slice(CLI::App& app, Session& session);
void add_probe(CLI::App& app, Session& session);
void add_experiment(CLI::App& app, Session& session);
void add_store(CLI::App& app, Session& session);
void add_restore(CLI::App& app, Session& session);
void add_verify(CLI::App& app, Session& session);
void add_isosurface(CLI::App& app, Session& session);
void add_completion(CLI::App& app, Session& session);
void add_man(CLI::App& app, Session& session);

/// The whole command line.
void add_all_commands(CLI::App& app, Session& session);

}  // namespace adamas
