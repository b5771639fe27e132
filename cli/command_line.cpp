#include "cli/command_line.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <span>
#include <sstream>
#include <string_view>
#include <vector>

#include "adamas/version.h"
#include "cli/config_file.h"
#include "cli/features.h"
#include "cli/help.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

/// The first steps for a newcomer: data to try, their content, a mesh, a view of it, help on a command.
constexpr const char* kFirstSteps =
    "First steps:\n"
    "  adamas generate scene voronoi10 --dimensions 48 -o cells.vtr\n"
    "  adamas info cells.vtr\n"
    "  adamas resample cells.vtr --interface-error 1% -o mesh.vtu\n"
    "  adamas slice mesh.vtu --plane z=0.5 -o slice.png\n"
    "  adamas resample --help";

/// Units of values of options, which follow the number.
constexpr std::string_view kUnits[] = {"%", "voxels", "voxel", "cells", "cell"};

void add_all_commands(const Command& root, Session& session) {
  const Command generate =
      root.add_command_group("generate", "Make a data set with known truth",
                             "adamas generate scene voronoi10 --dimensions 32,32,32 --seed 7 -o cells.vtr");
  add_generate_scene(generate, session);
  add_generate_impact(generate, session);
  add_generate_mixing(generate, session);
  add_generate_buckyball(generate, session);
  add_info(root, session);
  add_reconstruct(root, session);
  add_resample(root, session);
  add_select(root, session);
  add_compare(root, session);
  add_slice(root, session);
  add_probe(root, session);
  add_experiment(root, session);
  add_store(root, session);
  add_restore(root, session);
  add_verify(root, session);
  add_isosurface(root, session);
  add_play(root, session);
  if constexpr (kHasViewer) add_view(root, session);
  add_completion(root, session);
  add_man(root, session);
}

// The descriptions of the checks below are empty, so that the type names in the help stay as they are.

CLI::Validator not_empty() {
  return {[](std::string& value) { return value.empty() ? "expected a value, found an empty one" : ""; }, ""};
}

bool looks_like_option(const std::string& text) {
  return text.starts_with("--") ||
         (text.size() > 1 && text[0] == '-' && std::isalpha(static_cast<unsigned char>(text[1])) != 0);
}

CLI::Validator no_option() {
  return {[](std::string& value) {
            return looks_like_option(value) ? fmt::format("expected a value, found the option '{}'", value)
                                            : std::string();
          },
          ""};
}

CLI::Validator true_or_false() {
  return {[](std::string& value) {
            // CLI11 would convert the beginning of "2x".
            const bool number = !value.empty() && std::isdigit(static_cast<unsigned char>(value[0])) != 0;
            const bool whole = value.find_first_not_of("0123456789") == std::string::npos;
            bool converted = false;
            return (!number || whole) && CLI::detail::lexical_cast(value, converted)
                       ? std::string()
                       : fmt::format("expected no value, or true or false, found '{}'", value);
          },
          ""};
}

/// Adds the common checks to all options of a command and of its subcommands: no value is empty, no file or
/// name is another option, whose own value would then be lost, and flags are true or false.
void add_common_checks(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    if (option->get_items_expected_max() == 0) {  // a flag
      if (option != command.get_help_ptr()) option->check(true_or_false());
      continue;
    }
    const std::string type = option->get_type_name();
    if (type.find("FILE") != std::string::npos || type.find("NAME") != std::string::npos) {
      option->check(no_option());
    }
    option->check(not_empty());
  }
  for (CLI::App* inner : command.get_subcommands([](CLI::App*) { return true; })) add_common_checks(*inner);
}

std::string name_below(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  if (parsed.empty()) return {};
  const std::string inner = name_below(*parsed.front());
  return parsed.front()->get_name() + (inner.empty() ? "" : " " + inner);
}

const CLI::App& innermost_of(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : innermost_of(*parsed.front());
}

/// Returns the number of letters to insert, delete or change between one word and the other (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t change = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, change});
    }
  }
  return row[b.size()];
}

/// Returns " (did you mean X?)" for the most similar word; empty if all words are too different.
std::string suggestion(const std::string& found, const std::vector<std::string>& words) {
  std::size_t least = std::max<std::size_t>(found.size() / 3, 1) + 1;
  std::string nearest;
  for (const std::string& word : words) {
    const std::size_t distance = edit_distance(found, word);
    if (distance < least) least = distance, nearest = word;
  }
  return nearest.empty() ? nearest : fmt::format(" (did you mean {}?)", nearest);
}

std::string expected_command(const CLI::App& app) {
  std::string known;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
    known += (known.empty() ? "" : ", ") + names.back();
  }
  const auto rest = app.remaining();
  if (rest.empty()) return fmt::format("expected one of {}, found none", known);
  return fmt::format("expected one of {}, found '{}'{}", known, rest.front(),
                     suggestion(rest.front(), names));
}

/// Returns the message about surplus arguments. It names the first that looks like an option, since those
/// behind it may be its value; otherwise the first one.
std::string unexpected(const CLI::App& command, const std::string& command_name) {
  const auto rest = command.remaining();
  const auto is_option = [](const std::string& word) { return word.size() > 1 && word[0] == '-'; };
  const auto option = std::find_if(rest.begin(), rest.end(), is_option);
  if (option == rest.end()) {
    return fmt::format("expected no more arguments, found '{}'", rest.empty() ? "" : rest.front());
  }
  const std::string name = option->substr(0, option->find('='));
  std::vector<std::string> names;
  for (const CLI::Option* known : command.get_options()) {
    for (const std::string& long_name : known->get_lnames()) names.push_back("--" + long_name);
  }
  return fmt::format("expected an option of 'adamas{}', found '{}'{}",
                     command_name.empty() ? "" : " " + command_name, name, suggestion(name, names));
}

/// Returns the file of --config that could not be read. CLI11 begins with the one that was given last.
std::string unreadable_config(const CLI::App& app) {
  const std::vector<std::string> files = app.get_config_ptr()->results();
  const auto unreadable = [](const std::string& file) {
    return CLI::detail::check_path(file.c_str()) != CLI::detail::path_type::file ||
           !std::ifstream(file).good();
  };
  const auto found = std::find_if(files.rbegin(), files.rend(), unreadable);
  return fmt::format("--config: expected a file that can be read, found '{}'",
                     found == files.rend() ? "" : *found);
}

/// Returns the first required option or argument without a value.
std::string missing(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_required() && option->count() == 0) {
      return fmt::format("expected {}, found none", describe(*option).head);
    }
  }
  return {};
}

/// Returns whether a word of the command line is the option without its value: "--name", "-n", or "-vn" with
/// other short names before it.
bool names_option(std::string_view word, const CLI::Option& option) {
  if (word.ends_with('=')) word.remove_suffix(1);
  if (word.starts_with("--")) return option.check_lname(std::string(word.substr(2)));
  return word.starts_with("-") && option.check_sname(std::string(1, word.back()));
}

/// Returns a message where an option that expects one value has several; empty where no option has.
std::string several_values(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const std::vector<std::string>& values = option->results();
    if (option->get_multi_option_policy() != CLI::MultiOptionPolicy::Throw) continue;
    if (values.size() <= static_cast<std::size_t>(option->get_items_expected_max())) continue;
    // CLI11 returns no name for an option that --help does not show, as --config of the root.
    const std::string name =
        option->get_group().empty() ? "--" + option->get_lnames().front() : option->get_name();
    return fmt::format("{}: expected one value, found '{}'", name, fmt::join(values, "', '"));
  }
  return {};
}

/// Returns a message where the last word is an option without its value; empty where it is not.
std::string no_value(const CLI::App& command, std::string_view last_word) {
  for (const CLI::Option* option : command.get_options()) {
    if (!names_option(last_word, *option)) continue;
    return fmt::format("{}: expected a value {}, found none", option->get_name(), option->get_type_name());
  }
  return {};
}

bool is_number(std::string_view text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data(), end, value);
  return code == std::errc() && stop == end;
}

/// Throws Error for a unit that a blank separates from its number, since it would count as an input file.
void check_units(std::span<char* const> words) {
  for (std::size_t i = 1; i < words.size(); ++i) {
    std::string_view number = words[i - 1], unit = words[i];
    std::string option = i >= 2 && words[i - 2][0] == '-' ? fmt::format("{}: ", words[i - 2]) : "";
    if (const std::size_t equal = number.rfind('='); equal != number.npos) {
      if (number[0] == '-') option = fmt::format("{}: ", number.substr(0, equal));
      number.remove_prefix(equal + 1);
    }
    const bool is_unit = std::ranges::find(kUnits, unit) != std::end(kUnits);
    if (!is_unit || !is_number(number)) continue;
    std::error_code unknown;
    if (std::filesystem::exists(unit, unknown)) continue;
    wrong_usage("{}expected '{}{}' without a blank, found '{}' and '{}'", option, number, unit, number, unit);
  }
}

template <class Kind>
bool is(const CLI::ParseError& error) {
  return dynamic_cast<const Kind*>(&error) != nullptr;
}

/// Returns the message about a wrong command line. Where CLI11 found the error, its exception's type and the
/// state of the command tell the cause; messages of our own checks are in the exceptions themselves.
std::string usage_message(const CLI::ParseError& error, const CLI::App& app, std::string_view last_word) {
  const CLI::App& command = innermost_of(app);
  std::string message;
  if (is<CLI::RequiredError>(error) && command.get_require_subcommand_min() > 0) {
    message = expected_command(command);
  } else if (is<CLI::ExtrasError>(error)) {
    message = unexpected(command, name_below(app));
  } else if (is<CLI::FileError>(error)) {
    message = unreadable_config(app);
  } else if (is<CLI::ArgumentMismatch>(error)) {
    message = several_values(command);
    if (message.empty()) message = several_values(app);  // the root's option --config, which commands pass on
    if (message.empty()) message = no_value(command, last_word);
  } else if (is<CLI::RequiredError>(error)) {
    message = missing(command);
  }
  return message.empty() ? error.what() : message;
}

}  // namespace

CommandLine::CommandLine(Session& session)
    : app_(std::make_unique<CLI::App>(
          "Adaptive tetrahedral meshes of multi-material data, with sharp interfaces.", "adamas")),
      session_(session) {
  const Command root(*app_);
  app_->set_help_flag("--help,-h", "Print this and stop");
  app_->set_version_flag("--version", std::string("adamas ") + version(), "Print the version and stop");
  lay_out_help(root);
  // Each command has an option of this name that passes its file on to this one.
  app_->set_config("--config")->group("");
  app_->config_formatter(config_file(*app_));
  app_->require_subcommand(1);
  app_->footer(kFirstSteps);
  add_all_commands(root, session);
  add_common_checks(*app_);
}

CommandLine::~CommandLine() = default;

bool CommandLine::parse(int argc, char** argv) {
  check_units({argv, static_cast<std::size_t>(argc)});
  try {
    app_->parse(argc, argv);
    return true;
  } catch (const CLI::Success& page) {
    std::ostringstream text;
    app_->exit(page, text, text);
    session_.console.write(text.str());
    return false;
  } catch (const CLI::ParseError& error) {
    wrong_usage("{}", usage_message(error, *app_, argc > 1 ? argv[argc - 1] : ""));
  }
}

std::string CommandLine::named_command() const { return name_below(*app_); }

}  // namespace adamas::cli
