#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adamas/output_set.h"
#include "cli/console.h"

// CLI11's headers take seconds to compile, so the files of the commands see only the handles below.
namespace CLI {  // NOLINT(readability-identifier-naming): it is that library's
class App;
class Option;
}  // namespace CLI

namespace adamas::cli {

/// What all commands have in common: the options that every one takes, and what a run needs besides its own
/// options.
struct Session {
  std::string json;     ///< --json, empty where not given
  std::string threads;  ///< --threads
  std::string config;   ///< --config
  /// What a run has changed for good although it ends early: put behind the message that says so.
  std::string kept;
  Console console;
  OutputSet outputs;
  /// Set by the chosen command; called when the command line is known to be sound.
  std::function<void()> run;

  /// The program's own start: what has to be done between parsing and running.
  void begin();
  /// Gives the outputs their names, when standard output has taken all that was printed. Throws Error.
  void commit();
};

/// A handle of an option or of a positional argument, for its properties.
class CommandOption {
 public:
  explicit CommandOption(CLI::Option& option) : option_(&option) {}
  CommandOption required();
  /// What stands for the value in --help, as "FILE".
  CommandOption type_name(const std::string& name);
  /// The heading that --help lists the option under.
  CommandOption group(const std::string& name);
  /// One value per mention of the option.
  CommandOption one_value_each();
  /// --help tells the value that the variable has now.
  CommandOption show_default();
  /// Only these words are values.
  CommandOption one_of(const std::vector<std::string>& words);

 private:
  CLI::Option* option_;
};

/// A handle of a command, or of the whole command line, for its options and the commands below it. Variables
/// that take values have to outlive the command line.
class Command {
 public:
  using Conversion = std::function<void(const std::string& option, const std::string& text)>;

  explicit Command(CLI::App& app) : app_(&app) {}
  /// An option with a value ("--name,-n"), or a positional argument ("name").
  CommandOption add_option(const std::string& name, std::string& value, const std::string& description) const;
  CommandOption add_option(const std::string& name, std::vector<std::string>& values,
                           const std::string& description) const;
  /// An option whose text is converted when the command runs, and not where it is not given: `convert` is
  /// called with the name of the option and its text, and throws Error (kUsage). `text`: the default, if any.
  CommandOption add_converted(const std::string& name, const std::string& description, Conversion convert,
                              const std::string& text = {}) const;
  /// An option that may be given several times, each of which is converted in its turn.
  CommandOption add_converted_each(const std::string& name, const std::string& description,
                                   Conversion convert) const;
  /// An option without a value.
  CommandOption add_flag(const std::string& name, bool& value, const std::string& description) const;
  /// A command without options; `chosen` is called where the command line names it.
  Command add_command(const std::string& name, const std::string& description, const std::string& example,
                      std::function<void()> chosen) const;
  /// A command that needs one of those below it, as "generate" needs "scene".
  Command add_command_group(const std::string& name, const std::string& description,
                            const std::string& example) const;
  [[nodiscard]] CLI::App& app() const { return *app_; }
  /// Converts the values of all options that were added so.
  void convert() const;

 private:
  CLI::App* app_;
  std::shared_ptr<std::vector<std::function<void()>>> conversions_ =
      std::make_shared<std::vector<std::function<void()>>>();
};

/// A command with the options that all have. `example` is shown by --help. `run` is called for the command
/// that was chosen; it may throw Error.
Command add_command(const Command& parent, Session& session, const std::string& name,
                    const std::string& description, const std::string& example, std::function<void()> run);

// One function per command, in the file of its name; first the kinds of data that `adamas generate` makes.
void add_generate_scene(const Command& generate, Session& session);
void add_generate_impact(const Command& generate, Session& session);
void add_generate_mixing(const Command& generate, Session& session);
void add_generate_buckyball(const Command& generate, Session& session);
void add_info(const Command& root, Session& session);
void add_reconstruct(const Command& root, Session& session);
void add_resample(const Command& root, Session& session);
void add_select(const Command& root, Session& session);
void add_compare(const Command& root, Session& session);
void add_slice(const Command& root, Session& session);
void add_probe(const Command& root, Session& session);
void add_experiment(const Command& root, Session& session);
void add_store(const Command& root, Session& session);
void add_restore(const Command& root, Session& session);
void add_verify(const Command& root, Session& session);
void add_isosurface(const Command& root, Session& session);
void add_play(const Command& root, Session& session);
void add_view(const Command& root, Session& session);
void add_completion(const Command& root, Session& session);
void add_man(const Command& root, Session& session);

}  // namespace adamas::cli
