#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "adamas/output_set.h"
#include "cli/console.h"

// CLI11's headers take seconds to compile, so the files of the commands see only the handles below.
namespace CLI {  // NOLINT(readability-identifier-naming): the names are those of CLI11
class App;
class Option;
}  // namespace CLI

namespace adamas::cli {

/// The options that every command has, and the state of a run besides its own options.
struct Session {
  std::string json;         ///< --json, empty where not given
  std::size_t threads = 0;  ///< --threads; 0: all cores
  std::string config;       ///< --config
  /// What the run may allocate, in bytes; 0: any memory.
  std::size_t memory = 0;
  /// A lasting change of a run that ends early; it is appended to the error message.
  std::string kept;
  Console console;
  OutputSet outputs;
  /// The function of the chosen command, which is called when the command line is known to be valid.
  std::function<void()> run;

  /// Checks and applies the common options, before the function of the command. Throws Error (kUsage).
  void begin();
  /// Gives the outputs their names, after standard output has taken all text. Throws Error.
  void commit();
};

/// A handle of an option or of a positional argument, which sets its properties.
class CommandOption {
 public:
  explicit CommandOption(CLI::Option& option) : option_(&option) {}
  CommandOption required();
  /// One value per mention of the option.
  CommandOption one_value_each();
  /// Makes --help show the present value of the variable as the default.
  CommandOption show_default();
  /// Allows these words alone as values.
  CommandOption one_of(const std::vector<std::string>& words);

 private:
  CLI::Option* option_;
};

/// A handle of a command, or of the whole command line, which adds options and subcommands. Variables that
/// receive values have to outlive the command line.
class Command {
 public:
  using Conversion = std::function<void(const std::string& option, const std::string& text)>;

  explicit Command(CLI::App& app) : app_(&app) {}
  CommandOption add_option(const std::string& name, const std::string& type, const std::string& description,
                           std::string& value) const;
  CommandOption add_option(const std::string& name, const std::string& type, const std::string& description,
                           std::vector<std::string>& values) const;
  /// Adds an option whose text is converted when the command runs, if it is given: `convert` is
  /// called with the name of the option and its text, and throws Error (kUsage). `text`: the default, if any,
  /// which --help tells.
  CommandOption add_converted(const std::string& name, const std::string& type,
                              const std::string& description, Conversion convert,
                              const std::string& text = {}) const;
  /// Adds an option that may be given several times; each text is converted in its turn.
  CommandOption add_converted_each(const std::string& name, const std::string& type,
                                   const std::string& description, Conversion convert) const;
  /// Adds an option that names a file or folder.
  CommandOption add_file(const std::string& name, const std::string& type, const std::string& description,
                         std::filesystem::path& file) const;
  /// Adds an option whose value `parse` makes of its name and its text.
  template <class Value, class Parse>
  CommandOption add_value(const std::string& name, const std::string& type, const std::string& description,
                          Value& value, Parse parse, const std::string& text = {}) const {
    return add_converted(
        name, type, description,
        [&value, parse](const std::string& option, const std::string& given) {
          value = parse(option, given);
        },
        text);
  }
  /// Adds an option with such a value for each mention.
  template <class Value, class Parse>
  CommandOption add_values(const std::string& name, const std::string& type, const std::string& description,
                           std::vector<Value>& values, Parse parse) const {
    return add_converted_each(name, type, description,
                              [&values, parse](const std::string& option, const std::string& given) {
                                values.push_back(parse(option, given));
                              });
  }
  /// Adds an option that takes one of some words, each of which stands for a value.
  template <class Choice, class Value>
  CommandOption add_choice(const std::string& name, const std::string& description, Value& value,
                           const std::vector<std::pair<std::string, Choice>>& choices,
                           const std::string& text = {}) const {
    std::vector<std::string> words;
    for (const auto& [word, choice] : choices) words.push_back(word);
    const auto convert = [&value, choices](const std::string&, const std::string& given) {
      for (const auto& [word, choice] : choices) {
        if (word == given) value = choice;
      }
    };
    return add_converted(name, {}, description, convert, text).one_of(words);
  }
  /// Adds an option without a value.
  CommandOption add_flag(const std::string& name, const std::string& description, bool& value) const;
  /// Adds an option without a value; `take` is called when the command runs, if the option is given.
  CommandOption add_flag(const std::string& name, const std::string& description,
                         std::function<void()> take) const;
  /// Returns a handle of this command whose options --help lists under a heading.
  [[nodiscard]] Command in_group(const std::string& name) const;
  /// Adds a command without options; `chosen` is called if the command line names it.
  Command add_command(const std::string& name, const std::string& description, const std::string& example,
                      std::function<void()> chosen) const;
  /// Adds a command that needs one of its subcommands, as "generate" needs "scene".
  Command add_command_group(const std::string& name, const std::string& description,
                            const std::string& example) const;
  [[nodiscard]] CLI::App& app() const { return *app_; }
  /// Converts the values of all options that were added by add_converted() and add_converted_each().
  void convert() const;

 private:
  CommandOption finish(CLI::Option& option, const std::string& type) const;

  CLI::App* app_;
  std::string group_;
  std::shared_ptr<std::vector<std::function<void()>>> conversions_ =
      std::make_shared<std::vector<std::function<void()>>>();
};

/// Adds a command with the common options. `example` is shown by --help. `run` is called for the command that
/// was chosen; it may throw Error.
Command add_command(const Command& parent, Session& session, const std::string& name,
                    const std::string& description, const std::string& example, std::function<void()> run);

/// A command, and the options of its own, which last as long as the command line.
template <class Options>
struct CommandWithOptions {
  Command command;
  Options& options;
};

/// Adds such a command; `run` gets its options.
template <class Options>
CommandWithOptions<std::remove_const_t<Options>> add_command(const Command& parent, Session& session,
                                                             const std::string& name,
                                                             const std::string& description,
                                                             const std::string& example,
                                                             void (*run)(Options&, Session&)) {
  const auto options = std::make_shared<std::remove_const_t<Options>>();
  return {add_command(parent, session, name, description, example,
                      std::function<void()>([options, run, &session] { run(*options, session); })),
          *options};
}

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
